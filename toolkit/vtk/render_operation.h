#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// `render`: pictures of sequences.
Operation render_operation();

}  // namespace mimetra
