#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/correspondence/face_landmarks.h"

namespace mimetra {

/// Which vertex of a model each named landmark is, in the order of the file.
using LandmarkMapping = std::vector<std::pair<std::string, int>>;

/// Reads a mapping: eos' `[landmark_mappings]` with lines `9 = 33` (name = vertex; other sections
/// are left out), or one vertex a line for the landmarks "1", "2", .... Vertices are 0-based, '#'
/// starts a comment. Throws IoError that names the line.
LandmarkMapping read_landmark_mapping(const std::filesystem::path& path);

/// The mappings in a model's folder, `ibug_to_*.txt` and `landmarks68.txt`, in alphabetical order;
/// `model` is the folder or a file in it.
std::vector<std::filesystem::path> landmark_mappings(const std::filesystem::path& model);

/// That one. Throws IoError where there is none, or more than one.
std::filesystem::path find_landmark_mapping(const std::filesystem::path& model);

/// iBUG's landmarks of a mapping that names them 1 to 68, from 0 on; other names are left out.
LandmarkVertices ibug_landmarks(const LandmarkMapping& mapping);

}  // namespace mimetra
