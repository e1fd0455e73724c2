#pragma once

#include <vector>

#include "fitting/face_finder.h"
#include "toolkit/mesh/context.h"
#include "toolkit/operations/image_sequence.h"

/// Internal to track_face().
namespace mimetra {

/// Frames from one that is searched everywhere to the next, a second of most videos. Those between
/// depend on it and not on frames before, so that such chunks are searched side by side.
inline constexpr int kChunkFrames = 30;

/// The faces of each frame of a recording, which one thread reads in order while others search:
/// near those of the frame before, and everywhere in each chunk's first frame, and where fewer are
/// found than in the frame before. Throws as ImageSequence::image; Cancelled.
std::vector<FacesInImage> faces_of_recording(const ImageSequence& images, const FaceFinder& finder,
                                             double min_confidence, const Context& context = {});

}  // namespace mimetra
