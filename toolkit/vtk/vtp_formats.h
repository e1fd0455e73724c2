#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .vtp and .pvd: sequences with fields, regions, and region sets.
void add_vtp(OperationTable& table);

}  // namespace mimetra
