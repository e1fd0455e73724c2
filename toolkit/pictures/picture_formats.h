#pragma once

#include "toolkit/drawing/picture.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the format .png of pictures and tables, folders of pictures, and the operation `render`.
void add_pictures(OperationTable& table);

/// Options --yaw, --pitch and --up.
BoundParameters<Viewpoint> viewpoint_parameters();

}  // namespace mimetra
