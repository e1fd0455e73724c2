#pragma once

#include <filesystem>
#include <string>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Says that a column of kTimestamp is not used.
std::string note_on_timestamp(const std::string& name);

/// Reads weights as JSON, in any of the shapes of read_weights(). Internal to it.
WeightTrack read_weights_json(const std::filesystem::path& path);

}  // namespace mimetra
