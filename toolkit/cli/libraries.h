#pragma once

#include <string_view>

namespace mimetra::cli {

/// What `--version` says after the version: the licence, the instructions this was built for, and
/// the libraries it is made with.
std::string_view libraries();

}  // namespace mimetra::cli
