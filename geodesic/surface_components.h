#pragma once

#include <span>
#include <vector>

#include "geodesic/types.h"

namespace mimetra::geodesic {

/// One connected component as a mesh of its own, without degenerate triangles.
struct SurfaceComponent {
  /// Vertices of the whole mesh, ascending; row v of `positions` belongs to vertices[v].
  std::vector<VertexIndex> vertices;
  /// Relative to their centroid, so that a place far from the origin costs no digits.
  Positions positions;
  /// On rows of `positions`.
  Triangles triangles;
};

/// A mesh taken apart.
struct SurfaceComponents {
  /// In the order of each one's lowest vertex.
  std::vector<SurfaceComponent> components;
  /// Component of each vertex, and its row there; -1 where no triangle holds it.
  std::vector<int> component_of;
  std::vector<VertexIndex> row_of;
  int degenerate_triangles = 0;
  std::vector<VertexIndex> vertices_without_face;
};

enum class Degenerate { left_out, refused };

/// Throws std::invalid_argument that names the first triangle with a bad index or with a vertex
/// that is not finite, and the first degenerate one where they are refused.
SurfaceComponents surface_components(const Positions& positions, const Triangles& triangles,
                                     Degenerate degenerate);

/// Rows of `sources` in each component. Throws std::out_of_range that names the first bad one, and
/// std::invalid_argument when there is none.
std::vector<std::vector<VertexIndex>> sources_by_component(const SurfaceComponents& surface,
                                                           std::span<const VertexIndex> sources);

}  // namespace mimetra::geodesic
