#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the operation `operations`, which lists the table it is in. The table must outlive the
/// call.
void add_listing(OperationTable& table);

}  // namespace mimetra
