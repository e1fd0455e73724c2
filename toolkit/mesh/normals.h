#pragma once

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Normal of each triangle (M x 3), as long as twice its area.
Positions triangle_normals(const Eigen::Ref<const Positions>& positions,
                           const Triangles& triangles);

/// Sum of the normals of each vertex's triangles (N x 3).
Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles);
/// The same, of which welded vertices share theirs.
Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                         const Weld& weld);

}  // namespace mimetra
