#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/correspondence/face_landmarks.h"

namespace mimetra {

/// Named landmarks and the vertex of each, in the order of the file.
using LandmarkMapping = std::vector<std::pair<std::string, int>>;

/// Reads a mapping in one of two forms. The form of eos has lines `9 = 33` (name = vertex) in the
/// section `[landmark_mappings]`; other sections are ignored. A list has one vertex a line, for the
/// landmarks "1", "2", .... Vertices are 0-based, and '#' starts a comment. Throws IoError with the
/// line.
LandmarkMapping read_landmark_mapping(const std::filesystem::path& path);

/// Mappings in a model's folder, `ibug_to_*.txt` and `landmarks68.txt`, in alphabetical order.
/// `model` is the folder or a file in it.
std::vector<std::filesystem::path> landmark_mappings(const std::filesystem::path& model);

/// Returns the only mapping in a model's folder. Throws IoError if there is none or more than one.
std::filesystem::path find_landmark_mapping(const std::filesystem::path& model);

/// Landmarks that a mapping names 1 to 68, as in iBUG's scheme, numbered from 0. Ignores other
/// names.
LandmarkVertices ibug_landmarks(const LandmarkMapping& mapping);

}  // namespace mimetra
