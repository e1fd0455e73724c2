#include "toolkit/correspondence/face_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/surface_parts.h"

namespace mimetra {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A landmark beside the surface is projected to the nearest pixel within this share of the
/// drawing.
constexpr double kReach = 0.03;

/// Sizes of the drawings of a whole mesh, relative to drawings of a face. In the first, a head's
/// face has the 80 pixels that the finder needs. The face of a body, an eighth of its height, needs
/// the second.
constexpr std::array<double, 2> kOfWholeMesh = {2.0 / 3, 2};
/// A body with fewer vertices has no recognisable face.
constexpr Eigen::Index kFewestOfBody = 2000;
/// Ratio of the drawn square to the mesh, because detectors need a margin.
constexpr double kMargin = 1.15;

/// Lights from above and slightly from each side, as in rooms.
const std::array<Vector3d, 3> kLights = {Vector3d(0, 0.5, 1), Vector3d(-0.7, 0.5, 1),
                                         Vector3d(0.7, 0.5, 1)};

/// Tilt of the line from lips to eyes against the vertical, in degrees. Eyes lie farther back than
/// lips.
constexpr double kLean = 15;

/// Degrees to the side and up. Finders see faces up to about 30 degrees, with less accuracy at
/// larger angles.
constexpr std::array<std::pair<double, double>, 5> kTurns = {
    {{0, 0}, {-14, 0}, {14, 0}, {0, -10}, {0, 10}}};
constexpr int kFaceSamples = 3;
/// Side of the square around a face relative to its landmarks' radius. The square includes chin and
/// forehead.
constexpr double kSquare = 7;

constexpr double kDegree = std::numbers::pi / 180;

/// The 24 rotations that map axes to axes.
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

/// Nearest pixel that shows a wanted triangle; no triangle if there is none within reach.
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
  // The inside of a mask also looks like a face.
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

namespace {

/// Most certain face in drawings along the mesh's axes, each with every up direction. Empty if no
/// drawing shows a face. The drawings include all of `positions`.
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
    // Usually the first drawings show the face, so the others have no share of the progress.
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

/// Views of a face from several sides, the front first, each under all lights.
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

constexpr bool is_sought(int number) {
  return number == 8 || (number >= 17 && number < 60);
}

/// Outer corners of the eyes.
constexpr int kRightCorner = 36, kLeftCorner = 45;

/// Share of the views that must show the face, and that must agree about a landmark. Other shapes
/// may look like a face in one drawing, but not from all sides.
constexpr double kMajority = 0.5;
/// Fewer landmarks do not make a face.
constexpr std::size_t kFewestLandmarks = 12;

/// Largest distance of a landmark's vertex from it, as a share of the face's size.
constexpr double kVertexReach = 0.15;

/// Share of the progress for the search along the mesh's axes.
constexpr double kSearchShare = 0.6;

bool is_of_eyes(int number) {
  return number >= 36 && number < 48;  // an eyeball may show these instead of the lids
}

/// Connected part that shows most landmarks.
int skin_part(const SeenFace& seen, const Triangles& triangles, const SurfaceParts& parts) {
  std::map<int, int> landmarks;
  for (int i = 0; i < kFaceLandmarks; ++i) {
    if (!seen.points[i] || !is_sought(i) || is_of_eyes(i)) continue;
    ++landmarks[parts.of_vertex[triangles(seen.points[i]->triangle, 0)]];
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::ranges::max_element(landmarks, fewer)->first;
}

/// Cluster that contains most of some points: the mean of the points within reach of the median.
struct Agreement {
  Vector3d centre = Vector3d::Zero();
  double spread = 0;
  int points = 0;
};

Agreement agreement(const std::vector<Vector3d>& points, double reach) {
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const Vector3d& point : points) values.push_back(point[axis]);
    middle[axis] = median(std::move(values));
  }
  std::vector<Vector3d> near = points;
  std::erase_if(near, [&](const Vector3d& point) { return (point - middle).norm() > reach; });
  Agreement found;
  if (near.empty()) return found;
  found.points = static_cast<int>(near.size());
  for (const Vector3d& point : near) found.centre += point / found.points;
  for (const Vector3d& point : near) {
    found.spread += (point - found.centre).squaredNorm() / found.points;
  }
  found.spread = std::sqrt(found.spread);
  return found;
}

class FaceSearch {
 public:
  FaceSearch(const Head& head, const LandmarkFinder& finder, const FaceSearchOptions& options,
             const Context& context)
      : head_(head),
        finder_(finder),
        options_(options),
        context_(context),
        weld_(Weld::exact(head.mesh.positions)),
        triangles_(weld_.welded(head.mesh.connectivity.triangles)),
        parts_(surface_parts(head.mesh.positions, head.mesh.connectivity.triangles, weld_)),
        painter_(head.mesh) {}

  FaceLandmarks landmarks() {
    // Stray vertices do not affect the size of the drawings.
    const Positions& all = head_.mesh.positions;
    const Positions drawn =
        all(used_vertices(head_.mesh.connectivity.triangles, all.rows()), Eigen::all);
    const auto first = most_certain_face(painter_, drawn, finder_, options_.pixels,
                                         context_.part(0, kSearchShare));
    if (!first) fail("no face was found in drawings of it along all of its axes");
    skin_ = skin_part(*first, triangles_, parts_);
    const FacePlace place = nearer_place(*face_place(*first));
    const std::vector<MeshView> views = views_of(place, options_.pixels);
    const std::vector<SeenFace> seen = faces_in(views, context_.part(kSearchShare, 1));
    FaceLandmarks found;
    found.axes = place.axes;
    found.views = static_cast<int>(views.size());
    found.views_with_face = static_cast<int>(seen.size());
    for (const SeenFace& face : seen) {
      found.confidence += face.confidence / static_cast<double>(seen.size());
    }
    if (found.views_with_face > kMajority * found.views) agree(seen, found);
    if (found.found.size() < kFewestLandmarks) {
      fail("what looks like a face from one side does not from others");
    }
    snap(views, found);
    return found;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw MismatchError(head_.name + ": " + problem + "; pair vertices of both heads by hand");
  }

  bool is_skin(int t) const { return parts_.of_vertex[triangles_(t, 0)] == skin_; }

  std::vector<SeenFace> faces_in(const std::vector<MeshView>& views, const Context& context) const {
    std::vector<std::optional<SeenFace>> seen(views.size());
    const auto look = [&](int i) {
      seen[i] = seen_face(painter_, views[i], finder_, [this](int t) { return is_skin(t); });
    };
    parallel_for(static_cast<int>(views.size()), look, context);
    std::vector<SeenFace> faces;
    for (auto& face : seen) {
      if (face) faces.push_back(std::move(*face));
    }
    return faces;
  }

  /// Place of the face from drawings of its front instead of drawings along the mesh's axes.
  FacePlace nearer_place(const FacePlace& place) const {
    std::vector<MeshView> views = views_of(place, options_.pixels);
    views.resize(kLights.size());
    std::optional<FacePlace> best;
    double confidence = 0;
    for (const SeenFace& face : faces_in(views, context_.part(kSearchShare, kSearchShare))) {
      const auto found = face_place(face);
      if (!found || (best && face.confidence <= confidence)) continue;
      best = found;
      confidence = face.confidence;
    }
    return best.value_or(place);
  }

  std::vector<Vector3d> points_of(const std::vector<SeenFace>& seen, int number) const {
    std::vector<Vector3d> points;
    for (const SeenFace& face : seen) {
      if (face.points[number]) points.push_back(face.points[number]->position);
    }
    return points;
  }

  void agree(const std::vector<SeenFace>& seen, FaceLandmarks& found) const {
    const std::vector<Vector3d> left = points_of(seen, kLeftCorner),
                                right = points_of(seen, kRightCorner);
    // The size is unknown if the corners are not on the skin, as with eyes that are separate parts.
    if (left.empty() || right.empty()) return;
    const auto corner = [](const std::vector<Vector3d>& points) {
      return agreement(points, std::numeric_limits<double>::infinity()).centre;
    };
    found.size = (corner(left) - corner(right)).norm();
    const double most = options_.max_spread * found.size;
    for (int number = 0; number < kFaceLandmarks; ++number) {
      if (!is_sought(number)) continue;
      const std::vector<Vector3d> points = points_of(seen, number);
      if (points.empty()) continue;
      const Agreement most_of = agreement(points, 2 * most);
      if (most_of.points <= kMajority * found.views || most_of.spread > most) continue;
      found.found.push_back({number, -1, most_of.centre, most_of.spread, most_of.points});
    }
  }

  /// Corners of skin triangles that are visible from outside.
  std::set<VertexIndex> seen_vertices(const std::vector<MeshView>& views) const {
    std::set<VertexIndex> vertices;
    for (std::size_t i = 0; i < views.size(); i += kLights.size()) {
      for (const SeenPlace& place : painter_.draw(views[i]).places) {
        const int t = place.triangle;
        if (t < 0 || !is_skin(t) || !painter_.shows_outside(t, views[i])) continue;
        vertices.insert(triangles_.row(t).begin(), triangles_.row(t).end());
      }
    }
    return vertices;
  }

  /// Assigns vertices to landmarks. Of two landmarks at one vertex, the nearer stays.
  void snap(const std::vector<MeshView>& views, FaceLandmarks& found) const {
    std::map<VertexIndex, std::pair<double, int>> nearest;  // distance and number of the landmark
    const std::set<VertexIndex> vertices = seen_vertices(views);
    for (FaceLandmark& landmark : found.found) {
      double distance = kVertexReach * found.size;
      for (const VertexIndex v : vertices) {
        const double to_v = (head_.mesh.positions.row(v).transpose() - landmark.place).norm();
        if (to_v < distance) std::tie(distance, landmark.vertex) = std::tuple(to_v, v);
      }
      const std::pair own(distance, landmark.number);
      const auto [entry, added] = nearest.try_emplace(landmark.vertex, own);
      if (!added) entry->second = std::min(entry->second, own);
    }
    std::erase_if(found.found, [&](const FaceLandmark& landmark) {
      return landmark.vertex < 0 || nearest.at(landmark.vertex).second != landmark.number;
    });
  }

  const Head& head_;
  const LandmarkFinder& finder_;
  const FaceSearchOptions& options_;
  const Context& context_;
  Weld weld_;
  Triangles triangles_;
  SurfaceParts parts_;
  MeshPainter painter_;
  int skin_ = 0;
};

FaceLandmarks known_landmarks(const Head& head) {
  const Positions& positions = head.mesh.positions;
  FaceLandmarks landmarks;
  std::map<int, VertexIndex> sorted(head.known.begin(), head.known.end());
  std::set<VertexIndex> taken;
  for (const auto& [number, vertex] : sorted) {
    if (vertex < 0 || vertex >= positions.rows()) {
      throw MismatchError(head.name + ": landmark " + std::to_string(number + 1) +
                          " is said to be vertex " + std::to_string(vertex) +
                          ", the mesh has vertices 0 to " + std::to_string(positions.rows() - 1));
    }
    if (!taken.insert(vertex).second) continue;
    landmarks.found.push_back({number, vertex, positions.row(vertex), 0, 0});
  }
  if (sorted.contains(kRightCorner) && sorted.contains(kLeftCorner)) {
    landmarks.size =
        (positions.row(sorted[kLeftCorner]) - positions.row(sorted[kRightCorner])).norm();
  }
  return landmarks;
}

}  // namespace

double FaceLandmarks::mean_spread() const {
  double sum = 0;
  for (const FaceLandmark& landmark : found) sum += landmark.spread;
  return sum > 0 ? sum / (static_cast<double>(found.size()) * size) : 0;
}

FaceLandmarks find_landmarks(const Head& head, const LandmarkFinder& finder,
                             const FaceSearchOptions& options, const Context& context) {
  check_options(options);
  if (!head.known.empty()) return known_landmarks(head);
  if (!finder) {
    throw MismatchError(
        head.name +
        ": this program cannot find faces (it was built without dlib); pair vertices of both heads "
        "by hand");
  }
  return FaceSearch(head, finder, options, context).landmarks();
}

}  // namespace mimetra
