#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "toolkit/model/landmark_track.h"

/// Landmarks of MediaPipe's Face Landmarker. Internal to the readers of landmarks.
namespace mimetra {

/// Gives numbered landmarks MediaPipe's names, "mp0" to "mp477", where there are 468 of them, or
/// 478 with irises. Others keep theirs.
void name_mediapipe_landmarks(LandmarkTrack& track);

bool is_mediapipe(const LandmarkTrack& track);

/// The landmark at, or nearest to, one of iBUG's 68: "mp133" for "40". None for another name.
std::optional<std::string> mediapipe_name(std::string_view ibug);

/// Turns shares of the image's width and height, as MediaPipe counts, into pixels.
void scale_to_pixels(LandmarkTrack& track, int width, int height);

}  // namespace mimetra
