#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// Adds what VTK reads, writes and draws: .pvd and .vtp of regions and fields, region sets from
/// .vtp, .png, .html, and the operations `render` and `report`.
void add_vtk(OperationTable& table);

}  // namespace mimetra
