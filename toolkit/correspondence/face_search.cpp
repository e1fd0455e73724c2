#include "toolkit/correspondence/face_search.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A landmark that fell beside the surface is carried to pixels that are as near as this share of
/// the drawing.
constexpr double kReach = 0.03;

/// Drawings of a whole mesh, against those of a face alone: a head's face has the finder's 80
/// pixels; that of a body, an eighth of its height, needs more.
constexpr std::array<double, 2> kOfWholeMesh = {2.0 / 3, 2};
/// A body of fewer vertices has no face that a finder would know.
constexpr Eigen::Index kFewestOfBody = 2000;
/// What is drawn is larger than the mesh by this factor: detectors want a margin.
constexpr double kMargin = 1.15;

/// From above, and a little from each side, as rooms are lit.
const std::array<Vector3d, 3> kLights = {Vector3d(0, 0.5, 1), Vector3d(-0.7, 0.5, 1),
                                         Vector3d(0.7, 0.5, 1)};

/// Eyes lie behind lips: the line between them leans back by about this from the upright, in
/// degrees.
constexpr double kLean = 15;

/// Degrees to the side and up. Faces are found up to about 30; the farther, the less exactly.
constexpr std::array<std::pair<double, double>, 5> kTurns = {
    {{0, 0}, {-14, 0}, {14, 0}, {0, -10}, {0, 10}}};
constexpr int kFaceSamples = 3;
/// Side of the square around a face, over the radius of its landmarks: chin and forehead are in it.
constexpr double kSquare = 7;

constexpr double kDegree = std::numbers::pi / 180;

/// The 24 rotations that carry axes to axes.
std::vector<Matrix3d> axis_rotations() {
  std::vector<Matrix3d> rotations;
  const auto axis = [](int number) -> Vector3d {
    return (number % 2 == 0 ? 1 : -1) * Vector3d::Unit(number / 2);
  };
  for (int front = 0; front < 6; ++front) {
    for (int up = 0; up < 6; ++up) {
      if (front / 2 == up / 2) continue;
      Matrix3d rotation;
      rotation << axis(up).cross(axis(front)).transpose(), axis(up).transpose(),
          axis(front).transpose();
      rotations.push_back(rotation);
    }
  }
  return rotations;
}

std::vector<MeshView> views_along_axes(const Positions& positions, int pixels) {
  if (positions.rows() == 0) return {};
  const Eigen::RowVector3d low = positions.colwise().minCoeff(),
                           high = positions.colwise().maxCoeff();
  std::vector<MeshView> views;
  for (const Matrix3d& axes : axis_rotations()) {
    const Vector3d size = axes.cwiseAbs() * (high - low).transpose();
    MeshView view{axes, (low + high).transpose() / 2, kMargin * std::max(size[0], size[1]), pixels,
                  1};
    for (const Vector3d& light : {kLights[0], kLights[1]}) {
      view.light = light;
      if (view.side > 0) views.push_back(view);
    }
  }
  return views;
}

/// The nearest of the pixels that show what is wanted; nothing where none is within reach.
SeenPlace nearest_place(const MeshDrawing& drawing, const Eigen::RowVector2d& at,
                        const std::function<bool(int)>& wanted) {
  const double reach = kReach * drawing.image.width;
  double nearest = reach * reach;
  SeenPlace found;
  const auto first = [&](double middle) { return static_cast<int>(std::ceil(middle - reach)); };
  for (int y = first(at.y()); y <= at.y() + reach; ++y) {
    for (int x = first(at.x()); x <= at.x() + reach; ++x) {
      if (!drawing.image.contains(x, y)) continue;
      const double distance = (Eigen::RowVector2d(x, y) - at).squaredNorm();
      const SeenPlace& place = drawing.places[drawing.image.index(x, y)];
      if (distance >= nearest || place.triangle < 0 || !wanted(place.triangle)) continue;
      nearest = distance;
      found = place;
    }
  }
  return found;
}

Vector3d middle_of(const SeenFace& seen, int first, int count) {
  Vector3d sum = Vector3d::Zero();
  for (int i = first; i < first + count; ++i) sum += seen.points[i]->position;
  return sum / count;
}

}  // namespace

std::optional<SeenFace> seen_face(const MeshPainter& painter, const MeshView& view,
                                  const LandmarkFinder& finder,
                                  const std::function<bool(int)>& wanted) {
  const MeshDrawing drawing = painter.draw(view);
  const std::optional<FoundFace> face = finder(drawing.image);
  if (!face) return {};
  const auto shows = [&](int t) { return wanted(t) && painter.shows_outside(t, view); };
  SeenFace seen;
  seen.confidence = face->confidence;
  for (int i = 0; i < kFaceLandmarks; ++i) {
    const SeenPlace place = nearest_place(drawing, face->landmarks.row(i), shows);
    if (place.triangle >= 0) seen.points[i] = {place.triangle, painter.position(place)};
  }
  return seen;
}

std::optional<FacePlace> face_place(const SeenFace& seen) {
  constexpr int kFirst = 17, kCount = 43;  // brows to the outside of the lips
  for (int i = kFirst; i < kFirst + kCount; ++i) {
    if (!seen.points[i]) return {};
  }
  const Vector3d right_eye = middle_of(seen, 36, 6), left_eye = middle_of(seen, 42, 6),
                 lips = middle_of(seen, 48, 12);
  const Vector3d right = (left_eye - right_eye).normalized();
  const Vector3d front = right.cross((left_eye + right_eye) / 2 - lips).normalized();
  const Vector3d& tip = seen.points[30]->position;
  // The inside of a mask looks like a face too.
  if (!((tip - (left_eye + right_eye + lips) / 3).dot(front) > 0)) return {};
  const Vector3d level = Eigen::AngleAxisd(kLean * kDegree, right) * front;
  FacePlace face;
  face.axes << right.transpose(), level.cross(right).transpose(), level.transpose();
  face.middle = middle_of(seen, kFirst, kCount);
  double squares = 0;
  for (int i = kFirst; i < kFirst + kCount; ++i) {
    squares += (seen.points[i]->position - face.middle).squaredNorm();
  }
  face.radius = std::sqrt(squares / kCount);
  return face;
}

std::optional<SeenFace> most_certain_face(const MeshPainter& painter, const Positions& positions,
                                          const LandmarkFinder& finder, int pixels,
                                          const Context& context) {
  Context of_drawings = context;
  for (const double share : kOfWholeMesh) {
    if (share > 1 && positions.rows() < kFewestOfBody) break;
    const std::vector<MeshView> views =
        views_along_axes(positions, static_cast<int>(std::lround(share * pixels)));
    std::vector<std::optional<SeenFace>> seen(views.size());
    const auto look = [&](int i) {
      seen[i] = seen_face(painter, views[i], finder, [](int) { return true; });
    };
    parallel_for(static_cast<int>(views.size()), look, of_drawings);
    // The first drawings show the face as a rule: the others have no share of the progress.
    of_drawings = context.part(1, 1);
    std::optional<SeenFace> best;
    for (const auto& face : seen) {
      if (!face || !face_place(*face)) continue;
      if (!best || face->confidence > best->confidence) best = face;
    }
    if (best) return best;
  }
  return {};
}

std::vector<MeshView> views_of(const FacePlace& face, int pixels) {
  std::vector<MeshView> views;
  for (const auto& [yaw, pitch] : kTurns) {
    const Matrix3d turn = (Eigen::AngleAxisd(yaw * kDegree, Vector3d::UnitY()) *
                           Eigen::AngleAxisd(pitch * kDegree, Vector3d::UnitX()))
                              .toRotationMatrix();
    for (const Vector3d& light : kLights) {
      views.push_back(
          {turn * face.axes, face.middle, kSquare * face.radius, pixels, kFaceSamples, light});
    }
  }
  return views;
}

}  // namespace mimetra
