#pragma once

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Normal of each triangle (M x 3); its length is twice the area.
Positions triangle_normals(const Eigen::Ref<const Positions>& positions,
                           const Triangles& triangles);

/// Sum of the normals of each vertex's triangles (N x 3), not normalized.
Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles);
/// Vertex normals for which welded vertices count as one and get equal normals.
Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                         const Weld& weld);

}  // namespace mimetra
