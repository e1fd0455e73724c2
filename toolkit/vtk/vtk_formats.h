#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .vtp and .pvd, and scripts (.py) that show regions in ParaView.
void add_vtk(OperationTable& table);

}  // namespace mimetra
