#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Which vertex of a model each named landmark is, in the order of the file.
using LandmarkMapping = std::vector<std::pair<std::string, int>>;

/// Reads a mapping: eos' `[landmark_mappings]` with lines `9 = 33` (name = vertex; other sections
/// are left out), or one vertex a line for the landmarks "1", "2", .... Vertices are 0-based, '#'
/// starts a comment. Throws IoError that names the line.
LandmarkMapping read_landmark_mapping(const std::filesystem::path& path);

/// The mapping in a model's folder, `ibug_to_*.txt` or `landmarks68.txt`; `model` is the folder or
/// a file in it. Throws IoError where there is none, or more than one.
std::filesystem::path find_landmark_mapping(const std::filesystem::path& model);

/// Landmarks of a track that a mapping knows.
struct MappedLandmarks {
  std::vector<int> vertices;  ///< of the model, one per landmark (n)
  Frames points;              ///< F x 2n, as LandmarkTrack::points
  /// Those of iBUG's jaw (1 to 17 of 68) that the mapping lacks, which lie on the face's outline: F
  /// x 2m.
  Frames outline = {};
};

/// Takes them in the mapping's order; of MediaPipe's landmarks ("mp0" to "mp477") those at the
/// places of iBUG's that the mapping names. Throws MismatchError where there is none, and where
/// landmarks are numbered and the mapping has larger numbers.
MappedLandmarks map_landmarks(const LandmarkTrack& track, const LandmarkMapping& mapping);

}  // namespace mimetra
