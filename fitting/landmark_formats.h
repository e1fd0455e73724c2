#pragma once

#include <filesystem>
#include <limits>
#include <vector>

#include "toolkit/model/landmark_track.h"

/// What the readers of landmarks share. Internal to landmark_file.h.
namespace mimetra {

/// A coordinate of a landmark that was not seen.
constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// What numbers of frames say of a track without times: its step, and what is missing.
void number_frames(LandmarkTrack& track, const std::vector<long long>& numbers);

/// The reader of .json files. Throws IoError.
LandmarkTrack read_landmark_json(const std::filesystem::path& path);

}  // namespace mimetra
