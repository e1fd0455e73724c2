#pragma once

#include "toolkit/drawing/viewpoint.h"
#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// --yaw, --pitch and --up.
BoundParameters<Viewpoint> viewpoint_parameters();

/// `render`: pictures of sequences.
Operation render_operation();

}  // namespace mimetra
