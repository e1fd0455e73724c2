#pragma once

#include <filesystem>
#include <limits>
#include <vector>

#include "toolkit/model/landmark_track.h"

/// Helpers shared by the readers of landmarks. Internal to landmark_file.h.
namespace mimetra {

/// Coordinate of a landmark that was not seen.
constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// Sets the step of a track without times from its frame numbers, and notes missing frames.
void number_frames(LandmarkTrack& track, const std::vector<long long>& numbers);

/// Reads a .json file. Throws IoError.
LandmarkTrack read_landmark_json(const std::filesystem::path& path);

}  // namespace mimetra
