#include "toolkit/report/viewer_data.h"

namespace mimetra {

std::string_view viewer_script() {
  return {};
}

}  // namespace mimetra
