#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// From where meshes are seen: yaw, pitch and up.
std::vector<Parameter> view_parameters();

/// `render`: pictures of sequences.
Operation render_operation();

}  // namespace mimetra
