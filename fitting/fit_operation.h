#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the operation `fit`, its formats and, with dlib, the finder of landmarks in drawings.
void add_fitting(OperationTable& table);

}  // namespace mimetra
