#include "toolkit/report/viewer_script.h"

namespace mimetra {

std::string_view viewer_script() {
  return {};
}

}  // namespace mimetra
