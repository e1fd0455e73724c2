#pragma once

#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Vertices of triangles with area that are farther than kLeastMotion of the diameter from the rest
/// pose in some frame, ascending. Reads every frame. Throws what reading throws.
std::vector<VertexIndex> moving_vertices(const FrameSource& sequence);

/// The connected parts of a surface in which something moves. Lengths on a sequence, such as the
/// radius of regions, are shares of their size: a body or clothes that keep still beside a face do
/// not count.
struct MovingParts {
  /// True for vertices of these parts (N); empty for all, also where the other parts lie within
  /// these.
  std::vector<bool> vertices = {};
  /// Largest distance between two of them.
  double diameter = 0;
  /// True where what moves spans less than a third of these parts, as on a head and body in one
  /// piece. The diameter is then 1.5 times that of the vertices that move.
  bool is_section = false;
};

/// Of the vertices `moving`, on `rest` (N x 3) and `triangles`; all parts where none moves.
MovingParts moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                         const Triangles& triangles);

}  // namespace mimetra
