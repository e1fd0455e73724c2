#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the operations `operations` and `formats`, which list the table they are in. The table must
/// outlive the call.
void add_listing(OperationTable& table);

}  // namespace mimetra
