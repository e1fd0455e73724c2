#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A connected piece of triangles that holds no fixed vertex.
struct FloatingPiece {
  std::vector<VertexIndex> vertices;  // ascending; the first is the pin
};

/// Which vertices are unknowns of the vertex solve.
struct VertexUnknowns {
  /// Unknown of each vertex (N); -1 where it is fixed or the pin of a floating piece.
  std::vector<int> of_vertex;
  int count = 0;
  std::vector<FloatingPiece> floating;
  /// Some piece holds both fixed and free vertices.
  bool some_held = false;
};

/// Numbers the vertices that are not `fixed` (N), less one pin per floating piece of the triangles
/// of positive weight (M). Triangles that share one vertex are one piece.
VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed);

}  // namespace mimetra
