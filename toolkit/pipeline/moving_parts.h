#pragma once

#include <vector>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/pipeline/note.h"

namespace mimetra {

/// The connected parts of a surface in which something moves. Lengths on a sequence, such as the
/// radius of regions, are shares of their size: a body or clothes that keep still beside a face do
/// not count.
struct MovingParts {
  /// Those that are on one (N); empty for all, also where the other parts lie within these.
  std::vector<bool> vertices = {};
  /// Largest distance between two of them.
  double diameter = 0;
  /// True where what moves spans less than a third of these parts, as on a head and body in one
  /// piece. The diameter is then 1.5 times that of the vertices that move.
  bool is_section = false;
};

/// Measured on `rest` (N x 3). A vertex moves where it is farther than kLeastMotion from the
/// sequence's rest pose in some frame; where none does, all parts count. Reads every frame. Throws
/// what reading throws.
MovingParts moving_parts(const FrameSource& sequence, const Positions& rest);

/// The same; notes a section.
MovingParts moving_parts(const FrameSource& sequence, const Positions& rest, const Notes& notes);

}  // namespace mimetra
