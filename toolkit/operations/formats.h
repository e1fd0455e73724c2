#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// Adds the writers and region readers of io.
void add_formats(OperationTable& table);

}  // namespace mimetra
