#pragma once

#include <vector>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// A connected piece of triangles that holds no fixed vertex.
struct FloatingPiece {
  /// Ascending; of vertices that are one, the lowest.
  std::vector<VertexIndex> vertices;
  /// The first of `vertices` and all that are one with it.
  std::vector<VertexIndex> pin;
};

/// Which vertices are unknowns of the vertex solve.
struct VertexUnknowns {
  /// Unknown of each vertex (N), the same for those that are one; -1 where it is fixed or the pin
  /// of a floating piece.
  std::vector<int> of_vertex;
  int count = 0;
  std::vector<FloatingPiece> floating;
  /// The free vertices of each piece that fixed ones hold; ascending, of vertices that are one the
  /// lowest.
  std::vector<std::vector<VertexIndex>> held;
};

/// Numbers the vertices that are not `fixed` (N), less one pin per floating piece of the triangles
/// of positive weight (M). Triangles that share one vertex are one piece, also across a seam that
/// `weld` (N) closes. \pre vertices that are one are fixed together
VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed, const Weld& weld);

}  // namespace mimetra
