#include "samples/head/head_shape.h"

#include <array>
#include <cmath>

#include "samples/head/anatomy.h"
#include "samples/head/curves.h"

namespace mimetra::samples {
namespace {

constexpr double kEyeballRadius = 13;
// A closing lid moves along a straight line between two points of the lid surface, which passes up
// to 0.8 mm inside that surface.
constexpr double kLidThickness = 1.9;
constexpr double kEyeHalfWidth = 14;

/// Maximum of `a` and `b`, rounded over about `width` where they meet.
double smooth_max(double a, double b, double width) {
  return (a + b + std::sqrt(square(a - b) + square(width))) / 2;
}

/// Surface on which the left lids slide: z at (x, y), which is far behind the face beside the lids.
/// It is wider than the eyeball, so that the lids run smoothly into the corners of the eye.
double lid_surface(double x, double y) {
  constexpr double kWiderToNose = 0.82, kWiderToTemple = 0.96;
  const double radius = kEyeballRadius + kLidThickness;
  const double beside = x - kLeftEye.x();
  const double rest = square(radius) -
                      square(beside * (beside < 0 ? kWiderToNose : kWiderToTemple)) -
                      square(y - kLeftEye.y());
  return kLeftEye.z() + (rest > 1 ? std::sqrt(rest) : rest);
}

/// Opening of the cut between the lids at the skin point (x, y) on `side` (1 above, -1 below). The
/// upper lid is highest towards the nose, the lower one lowest away from it.
double lid_shift(double x, double y, int side, const Eyelids& lids) {
  constexpr double kReach[] = {19, 18};  // below, above
  constexpr double kMeeting = -3.4;      // height of the line on which the lids meet
  const double s = (x - kLeftEye.x()) / kEyeHalfWidth;
  const double d = std::abs(y) / kReach[side > 0];
  if (side == 0 || s * s >= 1 || d >= 1) return 0;
  const double line = kMeeting * (1 + 0.2 * s);
  const double opening = side > 0 ? lids.upper * (1 - 0.1 * s) : -lids.lower * (1 + 0.2 * s);
  return (line + opening) * (1 - s * s) * (1 - smooth_step(d));
}

/// Height that bends the line between the lips, and the skin around it, to a bow.
double lip_bow(double x, double d) {
  static const Curve height({{0, -0.4}, {6, 0.4}, {14, 0}, {26, 0}, {48, 0}});
  return height(std::abs(x)) * bump(square(d / 22));
}

/// Small gap that separates the closed lips, because coinciding vertices would count as one.
double lip_gap(double x, double d, int side) {
  constexpr double kHalfGap = 0.12, kReach = 6;
  const double s = x / kMouthHalfWidth;
  if (side == 0 || s * s >= 1 || std::abs(d) >= kReach) return 0;
  return side * kHalfGap * (1 - s * s) * square(1 - std::abs(d) / kReach);
}

/// Side of the cut in row `cut` on which a skin vertex is: 1 above, -1 below.
int side_of(const HeadVertex& vertex, double cut) {
  if (vertex.v < cut) return 1;
  return vertex.v > cut ? -1 : vertex.rim;
}

/// Position of a skin vertex at `u` >= 0, on the left half of the head.
Eigen::Vector3d left_skin_point(double u, const HeadVertex& vertex, const Eyelids& lids) {
  Eigen::Vector3d p = skull_point(u, vertex.v);
  // The features are on the front of the head and end before the ears.
  const double front = smooth_step((1 - u) / 0.3);
  const double lip = p.y() - skull_point(u, kMouthRow).y();
  p.y() += front * (lid_shift(p.x(), p.y(), side_of(vertex, kEyeRow), lids) + lip_bow(p.x(), lip) +
                    lip_gap(p.x(), lip, side_of(vertex, kMouthRow)));
  p = with_features(p, lip, front);
  if (u >= 1) return with_ear(p, u, vertex.v);
  p.z() = smooth_max(p.z(), lid_surface(p.x(), p.y()), 2.5);
  return p;
}

Eigen::Vector3d skin_point(const HeadVertex& vertex, const Eyelids& lids) {
  Eigen::Vector3d p = left_skin_point(std::abs(vertex.u), vertex, lids);
  if (vertex.u < 0) p.x() = -p.x();
  return p;
}

Eigen::Vector3d eye_center(int eye) {
  return {eye * kLeftEye.x(), kLeftEye.y(), kLeftEye.z()};
}

/// Position behind the lips: first their inner side, then up and down in front of the gums, palate
/// and floor.
Eigen::Vector3d mouth_point(const HeadVertex& vertex, const Eigen::Vector3d& source) {
  constexpr double kDepth[] = {3, 6, 13, 28, 48}, kHeight[] = {0.7, 8, 14, 16, 12},
                   kWidth[] = {0.95, 1, 1.05, 1.1, 1.1};
  const auto ring = static_cast<std::size_t>(vertex.ring - 1);
  const double rest = 1 - square(source.x() / kMouthHalfWidth);
  const double height = vertex.rim * kHeight[ring] * (rest > 0 ? std::sqrt(rest) : 0);
  // The inner side of the chin is further back than the inner side of the lips.
  const double chin = vertex.rim < 0 && vertex.ring > 1 ? 5 : 0;
  return {source.x() * kWidth[ring], source.y() + height, source.z() - kDepth[ring] - chin};
}

/// Position behind the lids: the lid's edge down to the eyeball, then inside the eyeball, so that
/// no gap shows.
Eigen::Vector3d eyelid_point(const HeadVertex& vertex, const Eigen::Vector3d& source) {
  constexpr double kOffEyeball[] = {0.9, -2};
  const Eigen::Vector3d center = eye_center(vertex.eye);
  const double radius = kEyeballRadius + kOffEyeball[vertex.ring - 1];
  return center + radius * (source - center).normalized();
}

/// Point of the unit sphere; `v` = 0 is (0, 0, 1), and `u` turns around the z axis.
Eigen::Vector3d ball_point(double u, double v) {
  static_assert(kBallColumns == 12);  // as many as the cosines below
  constexpr double kHalf = 0.5;
  const double h = std::sqrt(3.0) / 2;
  const std::array<double, kBallColumns> cosines = {1,  h,  kHalf,  0, -kHalf, -h,
                                                    -1, -h, -kHalf, 0, kHalf,  h};
  if (v >= 1) return {0, 0, -1};
  const auto column = static_cast<std::size_t>(std::lround(u * kBallColumns));
  const double t = v / (1 - v), scale = 1 / (1 + t * t);
  return {2 * t * scale * cosines[column], 2 * t * scale * cosines[(column + 9) % kBallColumns],
          (1 - t * t) * scale};
}

/// Position on an eyeball: a sphere with a dent for the pupil, as in marble.
Eigen::Vector3d eyeball_point(const HeadVertex& vertex) {
  constexpr double kIris = 0.23, kPupil = 0.12;
  const double t = vertex.v < 1 ? vertex.v / (1 - vertex.v) : 1;
  // The iris is a shallow dish, the pupil a pit in it.
  const double dent = t > kIris ? 0 : 0.9 + 2.2 * bump(square(t / kPupil));
  const Eigen::Vector3d radii(kEyeballRadius, kEyeballRadius, kEyeballRadius - dent);
  return eye_center(vertex.eye) + radii.cwiseProduct(ball_point(vertex.u, vertex.v));
}

}  // namespace

Positions head_positions(const HeadGrid& grid, const Eyelids& left, const Eyelids& right) {
  Positions positions(static_cast<Eigen::Index>(grid.vertices.size()), 3);
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    const HeadVertex& vertex = grid.vertices[static_cast<std::size_t>(i)];
    Eigen::Vector3d source = Eigen::Vector3d::Zero();
    if (vertex.source >= 0) source = positions.row(vertex.source);
    switch (vertex.part) {
      case HeadVertex::Part::skin:
        positions.row(i) = skin_point(vertex, vertex.u < 0 ? right : left);
        break;
      case HeadVertex::Part::mouth:
        positions.row(i) = mouth_point(vertex, source);
        break;
      case HeadVertex::Part::eyelid:
        positions.row(i) = eyelid_point(vertex, source);
        break;
      case HeadVertex::Part::eyeball:
        positions.row(i) = eyeball_point(vertex);
        break;
      case HeadVertex::Part::teeth:
        positions.row(i) = teeth_point(vertex);
        break;
      case HeadVertex::Part::tongue:
        positions.row(i) = tongue_point(ball_point(vertex.u, vertex.v));
        break;
    }
  }
  return positions;
}

}  // namespace mimetra::samples
