#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// The operation `fit`, and the reader of landmarks that it needs.
void add_fitting(OperationTable& table);

}  // namespace mimetra
