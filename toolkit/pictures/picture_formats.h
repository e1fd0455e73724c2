#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .png of pictures, folders of them, and the operation `render`.
void add_pictures(OperationTable& table);

}  // namespace mimetra
