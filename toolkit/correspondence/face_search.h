#pragma once

#include <array>
#include <functional>
#include <optional>

#include "toolkit/correspondence/mesh_drawing.h"
#include "toolkit/mesh/context.h"

/// Where the face is on a mesh. Internal to face_landmarks.h.
namespace mimetra {

/// A landmark carried back from a drawing onto the surface.
struct SeenPoint {
  int triangle;
  Eigen::Vector3d position;
};

/// Those of a face in a drawing.
struct SeenFace {
  /// None where no wanted triangle is near.
  std::array<std::optional<SeenPoint>, kFaceLandmarks> points;
  double confidence = 0;
};

/// A face as it is on a mesh.
struct FacePlace {
  /// Rows: right in a picture, up, where it looks.
  Eigen::Matrix3d axes;
  /// Of its brows, nose, eyes and lips: the middle, and the root mean square distance from it.
  Eigen::Vector3d middle;
  double radius;
};

/// Draws, finds, and carries each landmark back to the nearest pixel that shows a wanted triangle's
/// outside; none where there is no face.
std::optional<SeenFace> seen_face(const MeshPainter& painter, const MeshView& view,
                                  const LandmarkFinder& finder,
                                  const std::function<bool(int)>& wanted);

/// None where a landmark is not seen, or the nose does not stand out.
std::optional<FacePlace> face_place(const SeenFace& seen);

/// What is seen in the drawing along one of the mesh's axes, up along another, whose face is the
/// most certain; none where no drawing shows a face. All of `positions` are in the drawings.
std::optional<SeenFace> most_certain_face(const MeshPainter& painter, const Positions& positions,
                                          const LandmarkFinder& finder, int pixels,
                                          const Context& context);

/// From several sides, the front first, each under all lights; large enough for the finder.
constexpr int kFaceLights = 3;
std::vector<MeshView> views_of(const FacePlace& face, int pixels);

}  // namespace mimetra
