#pragma once

#include <memory>
#include <string>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// How much of a rest pose no mixture of a sequence's frames gives, wherever it stands and whatever
/// its size: of a clip that shows what its face does, hardly anything of its own neutral, and most
/// of how another face differs from it. Distances are root mean squares over vertices, as shares of
/// the diameter, of up to 1000 of the surface_vertices() and 128 frames.
struct RestBeyondFrames {
  /// From the nearest mixture of every other of these frames, moved, turned by little and scaled:
  /// of the rest pose, and of the frames between them, which are as far as noise is.
  double of_rest = 0;
  double of_frames = 0;
  /// What a tenth of the vertices stay below of the rest pose's distance.
  double least = 0;
  /// Of the frames from their mean.
  double spread = 0;
  int frames = 0;

  /// Whether the rest pose is likely that of another face. Measured on two captured takes and their
  /// own neutrals: 120 frames leave up to 0.014 % of them, 60 frames 0.15 %, 30 frames 0.8 %; with
  /// expressions that are held over 60 frames 0.5 %. Neutrals of other people leave up to 0.35 %
  /// at one, and 0.17 to 0.69 % at two standard deviations of one identity, 0.3 to 2.5 % where all
  /// differ, a fourth to a half of it everywhere. Where a part is still and the same, it says no.
  bool is_of_other_face() const;
};

/// "the rest pose is likely another face's: it lies 0.8 % of the size (RMS) beyond ...".
/// \pre rest.is_of_other_face()
std::string described(const RestBeyondFrames& rest);

/// Reads these frames once. All zero for fewer than four. Throws what reading throws, Cancelled.
RestBeyondFrames rest_beyond_frames(const std::shared_ptr<const FrameSource>& sequence,
                                    const Context& context = {});

}  // namespace mimetra
