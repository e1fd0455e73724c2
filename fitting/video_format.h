#pragma once

#include <filesystem>
#include <string>

#include "toolkit/operations/operation.h"

/// Videos of pictures. Internal to fit_operation.h.
namespace mimetra {

/// Adds .mp4, .mov and .mkv of pictures.
void add_video_format(OperationTable& table);

/// What is to be said where pictures are written to `target` without the sound of `video`; nothing
/// where it is kept, there is none, or `target` is no video. Throws IoError.
std::string lost_sound(const std::filesystem::path& target, const std::filesystem::path& video);

}  // namespace mimetra
