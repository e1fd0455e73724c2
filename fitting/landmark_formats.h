#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/model/landmark_track.h"

/// One reader for each format. Internal to landmark_file.h.
namespace mimetra {

LandmarkTrack read_pts(const std::filesystem::path& path);
LandmarkTrack read_landmark_csv(const std::filesystem::path& path);
LandmarkTrack read_landmark_json(const std::filesystem::path& path);

/// What numbers of frames say of a track without times: its step, and what is missing.
void number_frames(LandmarkTrack& track, const std::vector<long long>& numbers);

/// "1", "2", ...: iBUG counts its landmarks so.
std::vector<std::string> numbered_names(std::size_t count);

}  // namespace mimetra
