#pragma once

#include <string>

#include "toolkit/model/landmark_track.h"

/// What programs write for landmarks that they did not find. Internal to landmark_input.h.
namespace mimetra {

/// Makes NaN of landmarks at exactly (0, 0) or (-1, -1) that lie outside of the box of their
/// frame's others, and of frames that have nothing else. Returns what to say of it, "" for nothing.
std::string drop_placeholders(LandmarkTrack& track);

}  // namespace mimetra
