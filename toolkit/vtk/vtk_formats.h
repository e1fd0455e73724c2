#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// Adds what VTK reads and writes: .pvd and .vtp of regions and fields, region sets from .vtp.
void add_vtk_formats(OperationTable& table);

}  // namespace mimetra
