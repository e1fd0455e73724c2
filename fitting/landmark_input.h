#pragma once

#include <string>

#include <mimetra/operations/data.h>

namespace mimetra {

/// Reads the landmarks of a clip: one .pts, .csv or .json file, or a folder or pattern of .pts
/// files, one frame each in natural order; with times, the frames that `source.frames` takes.
/// Throws IoError, also for images where nothing finds landmarks in them; MismatchError for files
/// that differ in their number of landmarks, and as selected_frames.
LandmarksRead read_landmark_input(const std::string& text, const SequenceSource& source = {});

}  // namespace mimetra
