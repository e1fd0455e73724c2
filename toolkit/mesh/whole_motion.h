#pragma once

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// How much of a sequence's motion is one of the whole mesh.
struct WholeMotion {
  /// Of the rigid motions that fit the frames best, the largest: degrees, and how far the rest
  /// pose's centre goes.
  double angle = 0;
  double shift = 0;
  /// The size of the frames against the rest pose, the farthest from 1.
  double scale = 1;
  /// What those motions leave of all squared distances from the rest pose, and what they leave if
  /// each may also change the size; 1 where nothing moves, and for fewer than ten vertices, which
  /// tell no motion from a deformation.
  double left_by_motion = 1;
  double left_by_similarity = 1;

  /// Whether they are most of it. Expressions leave 0.46 and more: on two captured faces a jaw that
  /// moves alone 0.46 to 0.62, other expressions 0.5 to 0.92, whole takes 0.6 and 0.89; a head that
  /// nods by 4 degrees 0.07, one that was tracked in a room 0.10.
  bool moves() const { return left_by_motion < kMostlyMoved; }
  /// Whether their sizes are, and the motions without them are not.
  bool is_scaled() const;

  static constexpr double kMostlyMoved = 0.35;
};

/// Of one pose (N x 3).
WholeMotion whole_motion(const Positions& rest, const Positions& pose);

/// Reads the frames once. Throws what reading throws, Cancelled.
WholeMotion whole_motion(const FrameSource& source, const BlockOptions& options = {});

}  // namespace mimetra
