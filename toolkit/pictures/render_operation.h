#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// From where meshes are seen: yaw, pitch and up.
std::vector<Parameter> view_parameters();

/// What they say of the axis that points up.
bool is_z_up(const Parameters& parameters);

/// `render`: pictures of sequences.
Operation render_operation();

}  // namespace mimetra
