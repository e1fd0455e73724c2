#pragma once

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Part of a sequence's motion that moves the mesh (its surface_vertices()) as a whole.
struct WholeMotion {
  /// Largest angle (degrees), and largest shift of the rest pose's centre, of the rigid motions
  /// that fit the frames best.
  double angle = 0;
  double shift = 0;
  /// Size of the frames relative to the rest pose; the value farthest from 1.
  double scale = 1;
  /// Share of the summed squared distances from the rest pose that the rigid motions leave. It is 1
  /// if nothing moves beyond rounding, and for fewer than ten vertices.
  double left_by_motion = 1;
  /// The same share if each motion may also change the size.
  double left_by_similarity = 1;
  /// Distance moved by the stillest twentieth of the vertices of each frame, relative to the
  /// distance that the motions give them. Both are RMS, plus a hundredth of the mean motion. It is
  /// 1 if all moves as a whole, near 0 if some vertices stay, and 0 if left_by_motion is not
  /// measured.
  double of_stillest = 0;

  /// Whether rigid motions of the whole mesh explain most of the motion and leave no vertex behind.
  ///
  /// On captured faces, whole takes have left_by_motion 0.60 and 0.85, and a jaw moved sideways has
  /// 0.42. Their lower halves have 0.23, but of_stillest is 0.02 to 0.48 there. A head that turns
  /// or slides by as much has less than 0.35, with of_stillest from 0.5 to 1.
  bool moves() const { return left_by_motion < kMostlyMoved && of_stillest >= kFollowing; }
  /// Whether changes of size explain most of what the rigid motions leave, and exceed 5 %.
  bool is_scaled() const;

  static constexpr double kMostlyMoved = 0.35;
  static constexpr double kFollowing = 0.5;
};

/// Whole motion of one pose (N x 3), using all its vertices.
WholeMotion whole_motion(const Positions& rest, const Positions& pose);

/// Whole motion of a sequence. Reads the frames once. Throws whatever reading throws, and
/// Cancelled.
WholeMotion whole_motion(const FrameSource& source, const Context& context = {});

}  // namespace mimetra
