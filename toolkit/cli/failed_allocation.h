#pragma once

#include <cstddef>

namespace mimetra::cli {

/// Bytes that were asked for when memory was last refused to the program's own code; 0 where that
/// did not happen, or happened in a library of others.
std::size_t failed_allocation();

}  // namespace mimetra::cli
