#include "toolkit/report/base64.h"

#include <vtkBase64Utilities.h>

namespace mimetra {

std::string base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3), '=');
  text.resize(vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()),
                                         bytes.size(),
                                         reinterpret_cast<unsigned char*>(text.data())));
  return text;
}

}  // namespace mimetra
