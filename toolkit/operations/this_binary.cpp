#include "toolkit/operations/this_binary.h"

#include <string>
#include <system_error>

#include <dlfcn.h>

namespace mimetra {

std::filesystem::path this_binary() {
  Dl_info info{};
  const bool known = dladdr(reinterpret_cast<const void*>(&this_binary), &info) != 0;
  const std::string name = known && info.dli_fname ? info.dli_fname : "";
  // A program's name is what it was called by, which may not be a path.
  std::error_code error;
  return std::filesystem::canonical(name.find('/') == std::string::npos ? "/proc/self/exe" : name,
                                    error);
}

}  // namespace mimetra
