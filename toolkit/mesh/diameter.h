#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// The largest distance between two of the positions (N x 3): a size that does not change where a
/// mesh is turned or its vertices are renumbered. To rounding; points with a coordinate that is not
/// finite do not count. 0 for fewer than two.
///
/// Branch and bound over pairs of balls around halves of the points: close to N log N, on a sphere,
/// where every point has another that is as far, about N^1.5.
double diameter(const Eigen::Ref<const Positions>& positions);

/// That of the vertices of triangles with_area(), so that a stray point is no part of a mesh's
/// size; of those that triangles use where none has area, of all where there is no triangle.
double diameter(const Positions& positions, const Triangles& triangles);

}  // namespace mimetra
