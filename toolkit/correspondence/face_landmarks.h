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

/// iBUG's landmarks (0 to 67) and the vertex that each is.
using LandmarkVertices = std::vector<std::pair<int, VertexIndex>>;

/// A mesh with a face on it.
struct Head {
  std::string name;  ///< for messages
  TriMesh mesh;
  /// Landmarks that are known already; with any, none is looked for.
  LandmarkVertices known = {};
};

struct FaceSearchOptions {
  /// Of the places where the views see a landmark around their centre, as a share of the distance
  /// between the eyes' outer corners; landmarks that spread farther are left out.
  double max_spread = 0.06;
  /// Width and height of the drawings of a face; a finder may need half of it to see one.
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
  VertexIndex vertex;     ///< nearest to it of those seen
  Eigen::Vector3d place;  ///< in the mesh's axes and unit
  double spread;          ///< root mean square, in the mesh's unit
  int views;              ///< that agree
};

/// The landmarks of a head's face.
struct FaceLandmarks {
  std::vector<FaceLandmark> found;  ///< by number; no two at one vertex
  /// Rows: the face's own left, which is right in a picture, its up, and where it looks.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Between the outer corners of the eyes, in the mesh's unit.
  double size = 0;
  int views = 0;            ///< drawn; 0 where the landmarks were known
  int views_with_face = 0;  ///< those in which the finder found it
  double confidence = 0;    ///< mean of these

  /// Mean over the landmarks, as a share of `size`.
  double mean_spread() const;
};

/// Finds the landmarks of a head: in drawings along all axes of the mesh the most certain face,
/// then in drawings of that face from several sides under several lights the landmarks, which are
/// carried back onto the surface. A landmark is where most views agree; it is a vertex of the
/// connected part that shows most landmarks, the skin, and is seen from outside.
///
/// Not looked for: the inside of the lips (60 to 67), which one lip shares with the other where a
/// mouth is closed; the jaw but for the chin (8), as it lies on the outline, which is another part
/// of the surface in each view.
///
/// Known landmarks are taken as they are. Throws MismatchError that names the mesh if no face is
/// found, or if the mesh has no vertex of a known landmark; std::invalid_argument for options out
/// of range; Cancelled; what the finder throws.
FaceLandmarks find_landmarks(const Head& head, const LandmarkFinder& finder,
                             const FaceSearchOptions& options = {}, const Context& context = {});

/// A landmark carried back from a drawing onto the surface.
struct SeenPoint {
  int triangle;
  Eigen::Vector3d position;
};

/// Landmarks of a face in a drawing.
struct SeenFace {
  /// None where no wanted triangle is near.
  std::array<std::optional<SeenPoint>, kFaceLandmarks> points;
  double confidence = 0;
};

/// Draws, finds, and carries each landmark back to the nearest pixel that shows a wanted triangle's
/// outside; none where there is no face.
std::optional<SeenFace> seen_face(const MeshPainter& painter, const MeshView& view,
                                  const LandmarkFinder& finder,
                                  const std::function<bool(int)>& wanted);

/// A face as it is on a mesh.
struct FacePlace {
  /// Rows: right in a picture, up, where it looks.
  Eigen::Matrix3d axes;
  /// Middle of brows, nose, eyes and lips, and their root mean square distance from it.
  Eigen::Vector3d middle;
  double radius;
};

/// None where a landmark is not seen, or the nose does not stand out.
std::optional<FacePlace> face_place(const SeenFace& seen);

}  // namespace mimetra
