#pragma once

#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Vertices that are one point of the surface, as at UV seams and in every STL file.
struct Weld {
  /// For each vertex (N), the lowest vertex at the same place, which may be itself. Welds with a
  /// tolerance may also join places that are near.
  std::vector<VertexIndex> representative;
  /// Number of vertices that are not their own representative.
  int count = 0;

  /// Weld that joins no vertices.
  static Weld none(int vertices);
  /// Welds vertices with bitwise equal coordinates; 0 and -0 are equal. Throws
  /// std::invalid_argument if a vertex is not finite; the message names it.
  static Weld exact(const Positions& positions);

  /// Throws std::invalid_argument unless each of `positions` (N x 3) has a representative. This
  /// must be within `tolerance` (length), not above the vertex, and its own representative.
  void check(const Positions& positions, double tolerance = 0) const;

  /// Replaces vertices by their representatives (M x 3). Indices out of range are kept.
  Triangles welded(const Triangles& triangles) const;
};

/// Vertices that are farther than `tolerance` (length) from their representative in some frame,
/// ascending. Frames are read in blocks, or not at all if nothing is welded. Throws
/// std::invalid_argument if the vertex counts differ, whatever reading throws, and Cancelled.
std::vector<VertexIndex> parting_vertices(const FrameSource& sequence, const Weld& weld,
                                          double tolerance, const Context& = {});

/// Splits a weld so that every vertex stays within `tolerance` (length) of its representative in
/// all frames. Vertices that part from their representative are welded to the lowest of them, and
/// tested again. If nothing parts, the frames are read once. Throws as parting_vertices().
Weld staying_together(const FrameSource& sequence, const Weld& weld, double tolerance,
                      const Context& = {});

}  // namespace mimetra
