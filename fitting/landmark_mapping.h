#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/landmark_vertices.h"
#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Names of numbered landmarks, as iBUG counts: "1", "2", ...
std::vector<std::string> numbered_names(std::size_t count);

/// Renames 468 numbered landmarks, or 478 with irises, to MediaPipe's "mp0" to "mp477".
void name_mediapipe_landmarks(LandmarkTrack& track);

/// Landmarks of a track that occur in a mapping.
struct MappedLandmarks {
  std::vector<std::string> names;  ///< names of the landmarks (n) in the mapping
  std::vector<int> vertices;       ///< vertex of the model for each landmark (n)
  Frames points;                   ///< F x 2n, as LandmarkTrack::points
  /// iBUG's landmarks of the jaw (1 to 17 of 68) that the mapping lacks: F x 2m. They are on the
  /// outline of the face.
  Frames outline = {};
  /// Vertices of iBUG's landmarks (0 to 67), which the mapping names "1" to "68". Empty if another
  /// scheme numbers the track.
  LandmarkVertices ibug = {};
};

/// Selects the landmarks of a track in the mapping's order. For MediaPipe's landmarks ("mp0" to
/// "mp477") it takes those at the places of iBUG's landmarks in the mapping. Throws MismatchError
/// if no landmark is in the mapping, or if a numbered track lacks a landmark of the mapping.
MappedLandmarks map_landmarks(const LandmarkTrack& track, const LandmarkMapping& mapping);

/// True if landmarks of both eyes and of the mouth are known.
bool tell_axes(const LandmarkVertices& landmarks);

/// Reads iBUG's landmarks of a model with `vertices` vertices from the first mapping in its folder
/// that satisfies tell_axes(). Empty if there is none. Throws IoError if a mapping cannot be read.
LandmarkVertices landmarks_beside(const std::filesystem::path& model, int vertices);

/// Rotation after which the model looks along +z with y up. Among the rotations that exchange axes,
/// it is the nearest to the pose of eyes and mouth, which iBUG's landmarks (0 to 67) give. The
/// identity if an eye or the mouth has no landmark.
Eigen::Matrix3d looking_ahead(const Positions& neutral, const LandmarkVertices& landmarks);

}  // namespace mimetra
