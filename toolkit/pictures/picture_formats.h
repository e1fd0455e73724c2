#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .png of pictures and of tables, folders of pictures, and the operation `render`.
void add_pictures(OperationTable& table);

}  // namespace mimetra
