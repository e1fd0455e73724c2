#include <mimetra/samples/head_shape.h>

#include <array>
#include <cmath>

#include <mimetra/samples/curves.h>
#include <mimetra/samples/skull.h>

namespace mimetra::samples {
namespace {

constexpr double kEyeballRadius = 13;
// A closing lid moves on a straight line, up to 0.75 mm inside the sphere it starts and ends on.
constexpr double kLidThickness = 1.2;
constexpr double kEyeHalfWidth = 14;

/// A smooth elevation of the face seen from the front, on both sides of it.
struct Mound {
  double x, y;                ///< middle, mm
  double radius_x, radius_y;  ///< mm
  double height;              ///< forward, mm
};

constexpr Mound kMounds[] = {
    {30, 21, 30, 13, 4.5},     // brow ridge
    {0, 22, 14, 18, 2},        // between the brows
    {31, -1, 25, 20, -7},      // eye socket
    {19, -4, 11, 14, -3},      // beside the nose's root
    {46, -27, 32, 27, 5},      // cheekbone
    {46, -66, 26, 26, -3},     // hollow of the cheek
    {0, -66, 40, 30, 5},       // teeth behind the lips
    {0, -82, 26, 9, -3.5},     // below the lower lip
    {0, -97, 24, 17, 8},       // chin
    {14, -40, 8, 9, 5.5},      // wing of the nose
    {6.5, -47, 5, 4.5, -3.5},  // nostril
    {0, -53, 4, 9, -1.5},      // groove above the lip
    {27, -67, 7, 8, -2.5},     // corner of the mouth
};

double square(double x) {
  return x * x;
}

double mounds(double x, double y) {
  double height = 0;
  for (const Mound& mound : kMounds) {
    const double row = square((y - mound.y) / mound.radius_y);
    height += mound.height * bump(square((x - mound.x) / mound.radius_x) + row);
    if (mound.x > 0) height += mound.height * bump(square((x + mound.x) / mound.radius_x) + row);
  }
  return height;
}

double nose(double x, double y) {
  static const Curve ridge({{-56, 0},
                            {-50, 2.5},
                            {-45, 12},
                            {-40, 21},
                            {-35, 22.5},
                            {-28, 19.5},
                            {-12, 12},
                            {2, 6},
                            {12, 4},
                            {24, 0}});
  static const Curve half_width(
      {{-56, 13}, {-46, 16}, {-38, 18}, {-28, 15}, {-12, 12.5}, {2, 12}, {14, 15}, {24, 18}});
  const double s = square(x / half_width(y));
  return s >= 1 ? 0 : ridge(y) * square(1 - s);
}

/// `d` mm above the line between the lips.
double lips(double x, double d) {
  static const Curve upper({{-0.5, -1}, {0, 0}, {1.6, 3.2}, {4, 5}, {6.5, 4.2}, {9, 1.2}, {12, 0}});
  static const Curve lower(
      {{-16, 0}, {-12, 0.6}, {-9, 3}, {-5.5, 6}, {-2.5, 5}, {-0.8, 2}, {0, 0}, {0.5, -1}});
  const double s = square(x / (kMouthHalfWidth + 2));
  if (s >= 1) return 0;
  // The upper lip is highest beside the middle.
  const double thinner = 1 + 0.25 * s + 0.15 * bump(square(x / 6));
  return d > 0 ? upper(d * thinner) * (1 - s) : lower(d * (1 + 0.6 * s)) * (1 - square(s));
}

/// The larger of both, rounded over about `width` where they meet.
double smooth_max(double a, double b, double width) {
  return (a + b + std::sqrt(square(a - b) + square(width))) / 2;
}

/// The sphere on which the lids slide, in front of (x, y); far behind the face beside it.
double lid_sphere(double x, double y) {
  const double radius = kEyeballRadius + kLidThickness;
  const double rest =
      square(radius) - square(std::abs(x) - kLeftEye.x()) - square(y - kLeftEye.y());
  return kLeftEye.z() + (rest > 1 ? std::sqrt(rest) : rest);
}

/// How far the cut between the lids opens at the skin point (x, y) `side` (1 above, -1 below).
double lid_shift(double x, double y, int side, const Eyelids& lids) {
  constexpr double kReach[] = {17, 21};  // below, above
  const double s = (std::abs(x) - kLeftEye.x()) / kEyeHalfWidth;
  const double d = std::abs(y) / kReach[side > 0];
  if (side == 0 || s * s >= 1 || d >= 1) return 0;
  return (side > 0 ? lids.upper : lids.lower) * (1 - s * s) * square(1 - d);
}

/// Bends the line between the lips, with the skin around it, to a bow.
double lip_bow(double x, double d) {
  static const Curve height({{0, -0.2}, {6, 0.5}, {14, 0.3}, {26, -2}, {36, -1}, {48, 0}});
  return height(std::abs(x)) * bump(square(d / 22));
}

/// The closed lips lie a hair's breadth apart: vertices that coincide would count as one.
double lip_gap(double x, double d, int side) {
  constexpr double kHalfGap = 0.3, kReach = 6;
  const double s = x / kMouthHalfWidth;
  if (side == 0 || s * s >= 1 || std::abs(d) >= kReach) return 0;
  return side * kHalfGap * (1 - s * s) * square(1 - std::abs(d) / kReach);
}

/// Which side of the cut in row `cut` a skin vertex lies on.
int side_of(const HeadVertex& vertex, double cut) {
  if (vertex.v < cut) return 1;
  return vertex.v > cut ? -1 : vertex.rim;
}

double ear(double u, double v) {
  return bump(square((std::abs(u) - 1.13) / 0.16) + square((v - 5.75) / 0.95));
}

Eigen::Vector3d skin_point(const HeadVertex& vertex, const Eyelids& lids) {
  Eigen::Vector3d p = skull_point(vertex.u, vertex.v);
  if (std::abs(vertex.u) >= 1) {
    const double height = ear(vertex.u, vertex.v);
    p.x() += (vertex.u < 0 ? -15 : 15) * height;
    p.z() -= 10 * height;
    return p;
  }
  // The features sit on the front of the head and end before the ears.
  const double front = smooth_step((1 - std::abs(vertex.u)) / 0.3);
  const double d = p.y() - skull_point(vertex.u, kMouthRow).y();
  const double lip = lips(p.x(), d);
  p.y() += lid_shift(p.x(), p.y(), side_of(vertex, kEyeRow), lids) + front * lip_bow(p.x(), d) +
           lip_gap(p.x(), d, side_of(vertex, kMouthRow));
  const double face = p.z() + front * (mounds(p.x(), p.y()) + nose(p.x(), p.y()) + lip);
  p.z() = smooth_max(face, lid_sphere(p.x(), p.y()), 2);
  return p;
}

Eigen::Vector3d eye_center(int eye) {
  return {eye * kLeftEye.x(), kLeftEye.y(), kLeftEye.z()};
}

/// Behind the lips: the lips' inner side, then a pocket.
Eigen::Vector3d mouth_point(const HeadVertex& vertex, const Eigen::Vector3d& source) {
  constexpr double kDepth[] = {3.5, 9, 22}, kHeight[] = {0.3, 2.5, 6},
                   kWidth[] = {0.99, 0.95, 0.85};
  const auto ring = static_cast<std::size_t>(vertex.ring - 1);
  return {source.x() * kWidth[ring], source.y() + vertex.rim * kHeight[ring],
          source.z() - kDepth[ring]};
}

/// Behind the lids: the lid's edge, then the inside of the eyeball, so that no gap shows.
Eigen::Vector3d eyelid_point(const HeadVertex& vertex, const Eigen::Vector3d& source) {
  const Eigen::Vector3d center = eye_center(vertex.eye);
  if (vertex.ring == 1) return source - Eigen::Vector3d(0, 0, 1.5);
  const Eigen::Vector3d out = source - center;
  const double flat = square(out.x()) + square(out.y());
  const double radius = kEyeballRadius - 1.5;
  return {source.x(), source.y(),
          center.z() + std::sqrt(flat + 9 < square(radius) ? square(radius) - flat : 9)};
}

/// A sphere with a dent for the pupil, as in marble.
Eigen::Vector3d eyeball_point(const HeadVertex& vertex) {
  constexpr double kHalf = 0.5;
  const double h = std::sqrt(3.0) / 2;
  const std::array<double, 12> cosines = {1, h, kHalf, 0, -kHalf, -h, -1, -h, -kHalf, 0, kHalf, h};
  const auto column = static_cast<std::size_t>(vertex.u * 12 + 0.5);
  const double cos_around = cosines[column], sin_around = cosines[(column + 9) % 12];
  if (vertex.v >= 1) return eye_center(vertex.eye) - Eigen::Vector3d(0, 0, kEyeballRadius);
  const double t = vertex.v / (1 - vertex.v);
  const double sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  const double dent = 1.5 * bump(square(t / 0.25));
  return eye_center(vertex.eye) + Eigen::Vector3d(kEyeballRadius * sine * cos_around,
                                                  kEyeballRadius * sine * sin_around,
                                                  (kEyeballRadius - dent) * cosine);
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
    }
  }
  return positions;
}

}  // namespace mimetra::samples
