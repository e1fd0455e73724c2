#pragma once

#include <filesystem>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Reads weights as JSON, in any of the shapes of read_weights(). Internal to it.
WeightTrack read_weights_json(const std::filesystem::path& path);

}  // namespace mimetra
