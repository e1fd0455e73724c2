#pragma once

#include <cstddef>
#include <string>

namespace mimetra {

/// "1 frame", "300 frames"; what is not made plural by an s says how it is.
inline std::string counted(std::ptrdiff_t count, const std::string& one,
                           const std::string& several = "") {
  return std::to_string(count) + ' ' + (count == 1 ? one : several.empty() ? one + 's' : several);
}

}  // namespace mimetra
