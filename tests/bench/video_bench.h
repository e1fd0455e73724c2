#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/suite.h"

namespace mimetra::bench {

/// A video of 1920 x 1080 in which the built-in head talks: decoding alone, with pictures in RGB,
/// and with the face found near its last place, and in every whole frame. None where dlib's model
/// is missing. `scratch` is a folder for the video.
std::vector<Row> video_rows(const std::filesystem::path& scratch, const Settings& settings);

}  // namespace mimetra::bench
