#pragma once

#include <memory>
#include <string>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Part of a rest pose that no mixture of a sequence's frames gives, at any place and size.
///
/// It is small for the face's own neutral in a clip that shows what the face does. For another
/// face's neutral, it is most of the difference between the faces. Distances are root mean squares
/// over at most 1000 of the surface_vertices(), as shares of the diameter. At most 128 frames are
/// used.
struct RestBeyondFrames {
  /// Distance of the rest pose from the nearest mixture of every other frame, after small motions
  /// and a scaling.
  double of_rest = 0;
  /// The same distance for the frames in between; it shows the noise.
  double of_frames = 0;
  /// Distance that a tenth of the vertices of the rest pose stay below.
  double least = 0;
  /// Distance of the frames from their mean.
  double spread = 0;
  int frames = 0;

  /// Whether the rest pose is probably another face's. False if part of the face is still and both
  /// faces agree there.
  ///
  /// Two captured takes with their true neutrals give `of_rest` up to 0.014 % for 120 frames, 0.15
  /// % for 60 and 0.8 % for 30. It is 0.5 % if expressions are held over 60 frames. Other people's
  /// neutrals give up to 0.35 % at one standard deviation of one identity, and 0.17 to 0.69 % at
  /// two. If all identities differ, they give 0.3 to 2.5 %, and `least` is a fourth to a half of
  /// that.
  bool is_of_other_face() const;
};

/// Message "the rest pose is likely another face's: it lies 0.8 % of the size (RMS) beyond ...".
/// \pre rest.is_of_other_face()
std::string described(const RestBeyondFrames& rest);

/// Measures a sequence, reading each frame it uses once. For fewer than four frames, all distances
/// are 0. Throws whatever reading throws, and Cancelled.
RestBeyondFrames rest_beyond_frames(const std::shared_ptr<const FrameSource>& sequence,
                                    const Context& context = {});

}  // namespace mimetra
