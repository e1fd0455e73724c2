#pragma once

#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Which vertices are one point of the surface: UV seams, every STL file.
struct Weld {
  /// Lowest vertex at the same place, for each vertex (N); itself where it is alone or the first.
  std::vector<VertexIndex> representative;
  /// Vertices that are not their own representative.
  int count = 0;

  /// Nothing is welded.
  static Weld none(int vertices);
  /// Vertices whose coordinates are equal bit by bit (0 and -0 are equal). Throws
  /// std::invalid_argument that names a vertex which is not finite.
  static Weld exact(const Positions& positions);

  /// The same triangles on representatives, M x 3.
  Triangles welded(const Triangles& triangles) const;
};

/// Vertices welded in the rest pose that part in some frame by more than `tolerance` (length).
/// Throws std::invalid_argument where the weld is of another vertex count.
std::vector<VertexIndex> parting_vertices(const MeshSequence& sequence, const Weld& weld,
                                          double tolerance);

}  // namespace mimetra
