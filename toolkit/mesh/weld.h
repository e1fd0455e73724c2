#pragma once

#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Which vertices are one point of the surface: UV seams, every STL file.
struct Weld {
  /// Lowest vertex at the same place, or near it where it says so, for each vertex (N); itself
  /// where it is alone or the first.
  std::vector<VertexIndex> representative;
  /// Vertices that are not their own representative.
  int count = 0;

  /// Nothing is welded.
  static Weld none(int vertices);
  /// Vertices whose coordinates are equal bit by bit (0 and -0 are equal). Throws
  /// std::invalid_argument that names a vertex which is not finite.
  static Weld exact(const Positions& positions);

  /// Throws std::invalid_argument unless there is one representative for each of `positions` (N x
  /// 3), which is within `tolerance` (length) of it, its own representative, and not above its
  /// vertex.
  void check(const Positions& positions, double tolerance = 0) const;

  /// The same triangles on representatives, M x 3. An index out of range stays.
  Triangles welded(const Triangles& triangles) const;
};

/// Vertices that are farther than `tolerance` (length) from their representative in some frame,
/// ascending. Frames are read in blocks, and not at all where nothing is welded. Throws
/// std::invalid_argument where the weld is of another vertex count; what reading throws, Cancelled.
std::vector<VertexIndex> parting_vertices(const FrameSource& sequence, const Weld& weld,
                                          double tolerance, const Context& = {});

/// Splits what parts: every vertex of the result stays within `tolerance` (length) of its
/// representative in all frames. Those of one place that part from the lowest are welded to the
/// lowest of them, unless they part from it in turn, and so on; where nothing parts, the frames are
/// read once. Throws as parting_vertices().
Weld staying_together(const FrameSource& sequence, const Weld& weld, double tolerance,
                      const Context& = {});

}  // namespace mimetra
