#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/landmark_vertices.h"
#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// "1", "2", ...: iBUG counts its landmarks so.
std::vector<std::string> numbered_names(std::size_t count);

/// Gives numbered landmarks MediaPipe's names, "mp0" to "mp477", where there are 468 of them, or
/// 478 with irises. Others keep theirs.
void name_mediapipe_landmarks(LandmarkTrack& track);

/// Landmarks of a track that a mapping knows.
struct MappedLandmarks {
  std::vector<std::string> names;  ///< of the landmarks (n), as the mapping has them
  std::vector<int> vertices;       ///< of the model, one per landmark (n)
  Frames points;                   ///< F x 2n, as LandmarkTrack::points
  /// Those of iBUG's jaw (1 to 17 of 68) that the mapping lacks, which lie on the face's outline: F
  /// x 2m.
  Frames outline = {};
  /// Vertices of iBUG's landmarks (0 to 67), by the names "1" to "68"; none where the track's are
  /// numbered as another scheme has them.
  LandmarkVertices ibug = {};
};

/// Takes them in the mapping's order; of MediaPipe's landmarks ("mp0" to "mp477") those at the
/// places of iBUG's that the mapping names. Throws MismatchError where there is none, and where
/// landmarks are numbered and the mapping has larger numbers.
MappedLandmarks map_landmarks(const LandmarkTrack& track, const LandmarkMapping& mapping);

/// True for landmarks of both eyes and the mouth.
bool tell_axes(const LandmarkVertices& landmarks);

/// iBUG's landmarks of a model of so many vertices, where a mapping in its folder has those that
/// tell_axes(): tracks may name others. Else none. Throws IoError where a mapping cannot be read.
LandmarkVertices landmarks_beside(const std::filesystem::path& model, int vertices);

/// What carries a model to one that looks along +z with y up, by where iBUG's landmarks (0 to 67)
/// are on it: of the rotations that exchange axes the nearest to how its eyes and mouth lie. The
/// identity where it has no landmark of an eye or of the mouth.
Eigen::Matrix3d looking_ahead(const Positions& neutral, const LandmarkVertices& landmarks);

}  // namespace mimetra
