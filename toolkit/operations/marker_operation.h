#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds `markers`, which writes what the finder of landmarks finds on two heads to a file, and that
/// file's format.
void add_markers(OperationTable& table);

}  // namespace mimetra
