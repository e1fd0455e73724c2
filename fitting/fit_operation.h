#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// The operation `fit`, the reader of landmarks that it needs, and with dlib the finder of
/// landmarks in drawings.
void add_fitting(OperationTable& table);

}  // namespace mimetra
