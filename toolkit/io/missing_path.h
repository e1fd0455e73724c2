#pragma once

#include <string>

namespace mimetra {

/// Throws IoError for a path where nothing is, with the name of a file or folder beside it that is
/// nearly the same.
[[noreturn]] void fail_missing(const std::string& path);

}  // namespace mimetra
