#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the formats of add_vtp(), and scripts (.py) that show regions in ParaView.
void add_vtk(OperationTable& table);

/// Adds .vtp and .pvd for sequences with fields and for regions, and .vtp.series for reading.
void add_vtp(OperationTable& table);

}  // namespace mimetra
