#pragma once

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// How much of a sequence's motion is one of the whole mesh: of its surface_vertices().
struct WholeMotion {
  /// Of the rigid motions that fit the frames best, the largest: degrees, and how far the rest
  /// pose's centre goes.
  double angle = 0;
  double shift = 0;
  /// The size of the frames against the rest pose, the farthest from 1.
  double scale = 1;
  /// What those motions leave of all squared distances from the rest pose, and what they leave if
  /// each may also change the size; 1 where nothing moves by more than rounding, and for fewer than
  /// ten vertices, which tell no motion from a deformation.
  double left_by_motion = 1;
  double left_by_similarity = 1;
  /// How far the vertices go that move least, a twentieth of all in each frame, against where the
  /// motions take them (RMS, from a hundredth of the mean on): 1 in a motion of the whole, near 0
  /// where some stay. 0 where nothing moves.
  double of_stillest = 0;

  /// Whether they are most of it, and leave nothing behind. Of captured faces whole takes leave
  /// 0.60 and 0.85, a jaw to the side 0.42; so do their lower halves 0.23, but of_stillest is 0.02
  /// to 0.48 there. A head that turns or slides by as much leaves less than 0.35, with 0.5 to 1.
  bool moves() const { return left_by_motion < kMostlyMoved && of_stillest >= kFollowing; }
  /// Whether their sizes are, and the motions without them are not.
  bool is_scaled() const;

  static constexpr double kMostlyMoved = 0.35;
  static constexpr double kFollowing = 0.5;
};

/// Of one pose (N x 3), all of whose vertices count.
WholeMotion whole_motion(const Positions& rest, const Positions& pose);

/// Reads the frames once. Throws what reading throws, Cancelled.
WholeMotion whole_motion(const FrameSource& source, const Context& context = {});

}  // namespace mimetra
