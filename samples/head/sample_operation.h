#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra::samples {

/// Adds the operation `sample`, which writes the built-in head and its performance.
void add_sample(OperationTable& table);

}  // namespace mimetra::samples
