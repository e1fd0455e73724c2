#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/correspondence/mesh_drawing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// iBUG landmarks (0 to 67) and their vertices.
using LandmarkVertices = std::vector<std::pair<int, VertexIndex>>;

/// A mesh that shows a face.
struct Head {
  std::string name;  ///< name in messages
  TriMesh mesh;
  /// Landmarks that are already known. If there are any, no search takes place.
  LandmarkVertices known = {};
};

struct FaceSearchOptions {
  /// Largest spread of a landmark's places among the views, as a share of the distance between the
  /// eyes' outer corners. The spread is the root mean square distance from the centre. Landmarks
  /// with a larger spread are left out.
  double max_spread = 0.06;
  /// Width and height of the drawings of a face. A finder may need at least half of the default.
  int pixels = 384;

  static constexpr Option kMaxSpread{
      "max_spread", &FaceSearchOptions::max_spread, {.minimum = 0, .maximum = 1}};
  static constexpr Option kPixels{
      "pixels", &FaceSearchOptions::pixels, {.minimum = 64, .maximum = 2048}, "px"};
  static constexpr auto declared() { return std::tuple(kMaxSpread, kPixels); }
};

/// A landmark on which the views agree.
struct FaceLandmark {
  int number;             ///< 0 to 67
  VertexIndex vertex;     ///< nearest among the visible vertices
  Eigen::Vector3d place;  ///< in the mesh's axes and unit
  double spread;          ///< root mean square distance of the views' places, in the mesh's unit
  int views;              ///< number of views that agree
};

struct FaceLandmarks {
  std::vector<FaceLandmark> found;  ///< ascending by number; no two at one vertex
  /// Rows: the face's own left (right in a picture), its up, and its viewing direction.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Distance between the outer corners of the eyes, in the mesh's unit.
  double size = 0;
  int views = 0;            ///< number of drawings; 0 if the landmarks were known
  int views_with_face = 0;  ///< number of drawings in which the finder found the face
  double confidence = 0;    ///< mean over these drawings

  /// Mean spread of the landmarks, as a share of `size`.
  double mean_spread() const;
};

/// Finds the landmarks of a head. First, it selects the most certain face in drawings along all
/// axes of the mesh. It then draws that face from several sides under several lights, and projects
/// the landmarks back onto the surface.
///
/// Each landmark is where most views see it. Its vertex is visible from outside and belongs to the
/// skin, the connected part that shows most landmarks. Landmarks 60 to 67 (inside of the lips) are
/// not searched, because the lips share them if a mouth is closed. Of the jaw only the chin (8) is
/// searched, because the outline differs from view to view.
///
/// Known landmarks are returned unchanged. Throws MismatchError if no face is found, the finder is
/// empty, or the mesh lacks the vertex of a known landmark. The message names the mesh. Throws
/// std::invalid_argument if an option is out of range. Throws what the finder throws, and
/// Cancelled.
FaceLandmarks find_landmarks(const Head& head, const LandmarkFinder& finder,
                             const FaceSearchOptions& options = {}, const Context& context = {});

/// A landmark projected from a drawing back onto the surface.
struct SeenPoint {
  int triangle;
  Eigen::Vector3d position;
};

/// Landmarks of a face in a drawing.
struct SeenFace {
  /// Landmarks without a wanted triangle nearby are empty.
  std::array<std::optional<SeenPoint>, kFaceLandmarks> points;
  double confidence = 0;
};

/// Draws a view and finds its face. Each landmark is projected to the nearest pixel that shows the
/// outside of a wanted triangle. Empty if the drawing shows no face.
std::optional<SeenFace> seen_face(const MeshPainter& painter, const MeshView& view,
                                  const LandmarkFinder& finder,
                                  const std::function<bool(int)>& wanted);

struct FacePlace {
  /// Rows: right in a picture, up, and the viewing direction.
  Eigen::Matrix3d axes;
  /// Mean of brows, nose, eyes and lips, and their root mean square distance from it.
  Eigen::Vector3d middle;
  double radius;
};

/// Empty if one of the landmarks 17 to 59 is missing, or the nose does not protrude.
std::optional<FacePlace> face_place(const SeenFace& seen);

}  // namespace mimetra
