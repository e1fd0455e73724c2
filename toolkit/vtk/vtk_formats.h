#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .vtp and .pvd, and scripts (.py) that show regions in ParaView.
void add_vtk(OperationTable& table);

/// Adds .vtp and .pvd: sequences with fields, regions, and region sets.
void add_vtp(OperationTable& table);

}  // namespace mimetra
