#include "samples/head/anatomy.h"

#include <array>
#include <cmath>

#include "samples/head/curves.h"

namespace mimetra::samples {

namespace {

/// Horizontal section of the head: its foremost, widest and rearmost point.
struct Section {
  double front_y, front_z;
  double side_x, side_y, side_z;
  double back_y, back_z;
};

// Sections from below the crown to the end of the neck. From the cheeks down they rise towards the
// back, as a jaw does.
constexpr std::array<Section, 12> kSections = {{
    {107, 26, 38, 106, -11, 103, -50},     // 1
    {91, 55, 57, 89, -12, 85, -81},        //
    {67, 75, 70, 65, -13, 56, -97},        //
    {34, 84, 75, 33, -12, 20, -101},       // 4: brows
    {0, 80, 72, 0, -10, -14, -97},         // kEyeRow
    {-46, 82, 68, -34, -8, -42, -84},      // 6: below the nose
    {-66, 82, 64, -50, -8, -53, -76},      // kMouthRow
    {-98, 76, 56, -68, -10, -66, -70},     // 8: chin
    {-112, 62, 50, -78, -14, -76, -67},    //
    {-115, 36, 47, -88, -18, -88, -65},    // 10: below the jaw
    {-124, 14, 48, -108, -24, -110, -65},  //
    {-150, 8, 54, -149, -26, -148, -70},   // 12: end of the neck
}};

double Section::*const kQuantities[] = {&Section::front_y, &Section::front_z, &Section::side_x,
                                        &Section::side_y,  &Section::side_z,  &Section::back_y,
                                        &Section::back_z};

constexpr double kCrownY = 113.5;
constexpr double kCrownZ = -12;

/// Section by index. Section 0 is the crown and -1 is section 1 turned back to front, which makes
/// the crown round.
Section section_at(int index) {
  if (index > 12) index = 12;
  if (index >= 1) return kSections[static_cast<std::size_t>(index - 1)];
  if (index == 0) return {kCrownY, kCrownZ, 0, kCrownY, kCrownZ, kCrownY, kCrownZ};
  const Section& first = kSections[0];
  return {first.back_y, first.back_z,  -first.side_x, first.side_y,
          first.side_z, first.front_y, first.front_z};
}

/// Catmull-Rom interpolation between the sections.
Section section_between(double v) {
  int index = static_cast<int>(v);
  if (index > 11) index = 11;
  const double t = v - index;
  const double weights[4] = {t * (t * (2 - t) - 1) / 2, (t * t * (3 * t - 5) + 2) / 2,
                             t * (t * (4 - 3 * t) + 1) / 2, t * t * (t - 1) / 2};
  Section result{};
  for (int i = 0; i < 4; ++i) {
    const Section section = section_at(index - 1 + i);
    for (const auto quantity : kQuantities) result.*quantity += weights[i] * section.*quantity;
  }
  return result;
}

}  // namespace

Eigen::Vector3d skull_point(double u, double v) {
  const Section section = section_between(v);
  const double side = u < 0 ? -1 : 1;
  const double a = side * u;
  const bool front = a <= 1;
  const double t = front ? a : 2 - a;  // tangent of half the angle from the front or the back
  const double sine = 2 * t / (1 + t * t);
  const double cosine = (1 - t * t) / (1 + t * t);
  const double end_y = front ? section.front_y : section.back_y;
  const double end_z = front ? section.front_z : section.back_z;
  // The fourth power keeps the rows of the face level and bends them on the cheeks.
  const double to_side = sine * sine * sine * sine;
  return {side * section.side_x * sine, end_y + (section.side_y - end_y) * to_side,
          section.side_z + (end_z - section.side_z) * cosine};
}

namespace {

using Vector = Eigen::Vector3d;

// Bones under the skin, then the parts of the nose: middle, radii, push.
const Stroke kBones[] = {
    {{30, 20, 74}, {34, 15, 60}, {0, 0, 4.5}},     // brow ridge
    {{0, 16, 84}, {13, 16, 60}, {0, 0, 0.8}},      // between the brows
    {{30, -1, 68}, {24, 19, 60}, {0, 0, -8}},      // eye socket
    {{17, -3, 76}, {10, 14, 60}, {0, 0, -2.5}},    // beside the nose's root
    {{66, 8, 25}, {30, 34, 40}, {-3, 0, 0}},       // temple
    {{44, -26, 60}, {32, 28, 60}, {1, 0, 5}},      // cheekbone
    {{44, -62, 52}, {28, 30, 50}, {-1, 0, -1.5}},  // hollow of the cheek
    {{0, -64, 82}, {40, 28, 60}, {0, 0, 5}},       // teeth behind the lips
    {{0, -83, 80}, {26, 9, 60}, {0, 0, -3.5}},     // below the lower lip
    {{0, -100, 78}, {23, 16, 60}, {0, 0, 8}},      // chin
    {{56, -74, 10}, {36, 40, 60}, {3, -2, 0}},     // angle of the jaw
    {{44, 0, 60}, {12, 12, 60}, {0, 1.6, 0}},      // outer corner of the eye
    {{16, 0, 70}, {9, 10, 60}, {0, -0.8, 0}},      // inner corner of the eye
};

const Stroke kNose[] = {
    {{0, -38, 104}, {11, 10, 60}, {0, -3.5, 1}},      // tip
    {{5, -38, 100}, {7, 9, 60}, {1, 0, 1.5}},         // ball of the tip
    {{12.5, -41.5, 90}, {8, 8.5, 60}, {2.5, -1, 6}},  // wing
    {{19, -41, 84}, {6, 10, 60}, {-1, 0, -2}},        // crease behind the wing
    {{7.5, -48.5, 90}, {5.5, 5, 60}, {0, 2, -4}},     // nostril
    {{0, -50, 90}, {6.5, 6, 60}, {0, 0, 1}},          // bridge between the nostrils
    {{28, -55, 75}, {6, 18, 60}, {0, 0, -1.2}},       // fold from nose to mouth
};

double nose_ridge(double x, double y) {
  static const Curve ridge({{-56, 0},
                            {-51, 1.5},
                            {-47, 6},
                            {-43, 15},
                            {-39, 20.5},
                            {-35, 21.5},
                            {-28, 19},
                            {-12, 12},
                            {2, 7},
                            {12, 5},
                            {26, 0}});
  static const Curve half_width(
      {{-56, 10}, {-46, 11}, {-38, 16}, {-28, 16}, {-12, 15}, {2, 14}, {14, 17}, {26, 20}});
  const double s = square(x / half_width(y));
  return s >= 1 ? 0 : ridge(y) * square(1 - s);
}

/// Relief of an eyebrow, carved as a low arc.
double eyebrow(double x, double y) {
  static const Curve arc({{6, 19}, {14, 20.5}, {26, 24}, {34, 25}, {44, 21.5}, {52, 15}});
  static const Curve strength({{6, 0}, {17, 0.8}, {30, 1}, {52, 0}});
  return 2.0 * strength(std::abs(x)) * bump(square((y - arc(std::abs(x))) / 8));
}

/// Relief of the lips: two rolls that touch at d = 0.
double lips(double x, double d) {
  static const Curve upper(
      {{0, 0}, {1.2, 1.6}, {3.2, 3.1}, {5.5, 3.6}, {8, 2.0}, {10, 0.9}, {13, 0}});
  static const Curve lower(
      {{-18, 0}, {-13, 0.3}, {-10, 1.8}, {-7, 4.2}, {-4.5, 4.6}, {-2.2, 3.2}, {-0.8, 1.4}, {0, 0}});
  const double s = square(x / (kMouthHalfWidth + 2));
  if (s >= 1) return 0;
  const double touching = 2.6 * (1 - s) * bump(square(d / 10));
  // The upper lip is highest beside the middle.
  const double thinner = 1 + 0.35 * s + 0.15 * bump(square(x / 6));
  return touching +
         (d > 0 ? upper(d * thinner) * (1 - s) : lower(d * (1 + 0.7 * s)) * (1 - square(s)));
}

/// Relief of the groove from nose to lip, and of the dents at the corners of the mouth.
double beside_lips(double x, double d) {
  return -1.3 * bump(square(x / 4.5) + square((d - 12) / 9)) -
         2 * bump(square((std::abs(x) - 27.5) / 6) + square((d + 0.5) / 7));
}

}  // namespace

Eigen::Vector3d with_features(const Eigen::Vector3d& p, double lip, double front) {
  Vector result = sculpted_on_both_sides(p, kBones);
  if (front <= 0) return result;
  result.z() += front * (nose_ridge(p.x(), p.y()) + eyebrow(p.x(), p.y()) + lips(p.x(), lip) +
                         beside_lips(p.x(), lip));
  return sculpted_on_both_sides(result, kNose);
}

Eigen::Vector3d with_ear(const Eigen::Vector3d& p, double u, double v) {
  // Section through the ear at one height, from its front to behind it, and its scale by height.
  static const Curve outward({{1, 0}, {1.06, 0}, {1.11, 8}, {1.16, 16}, {1.21, 13}, {1.27, 0}});
  static const Curve backward(
      {{1, 0}, {1.06, 6}, {1.11, 12}, {1.16, 6}, {1.21, 8}, {1.27, -4}, {1.42, 0}});
  static const Curve size({{4.5, 0},
                           {4.62, 0.5},
                           {4.85, 0.9},
                           {5.15, 1},
                           {5.5, 0.9},
                           {6, 0.6},
                           {6.2, 0.38},
                           {6.4, 0.12},
                           {6.54, 0}});
  return p + size(v) * Vector(outward(u), 0, -backward(u));
}

namespace {

/// z of the upper front teeth, and height of the edges of both jaws' teeth above the line between
/// the lips, mm.
constexpr double kFront = 80, kEdge = -3;

/// A point around a tooth, mm: its distance in front of the jaw's arch (negative behind it), and
/// the distance from the edge towards the gum.
struct Around {
  double out;
  double up;
};
constexpr std::array<Around, kToothPoints> kIncisor = {{{0.6, 0},
                                                        {1.6, 4},
                                                        {1.3, 8.5},
                                                        {2.4, 9.8},
                                                        {1.8, 15},
                                                        {-5, 15},
                                                        {-4.5, 9.5},
                                                        {-2.2, 4},
                                                        {-0.6, 0}}};
constexpr std::array<Around, kToothPoints> kMolar = {
    {{1.6, 0}, {2.6, 3}, {2, 6.5}, {3, 7.8}, {2.4, 15}, {-8, 15}, {-7.5, 8}, {-6.4, 3}, {-5, 0}}};
/// Offset of the points between two teeth: a groove, with the gum in its corner.
constexpr std::array<Around, kToothPoints> kBetween = {{{-0.5, 0.6},
                                                        {-1.2, 0},
                                                        {-0.8, -2.2},
                                                        {-0.4, -1.6},
                                                        {0, 0},
                                                        {0, 0},
                                                        {0.3, -2},
                                                        {0.9, 0},
                                                        {0.3, 0.6}}};

/// Arch of the jaw at `u` >= 0 as in HeadVertex: x, and z relative to its middle (negative behind).
Eigen::Vector2d arch(double u) {
  static const Curve beside({{-1, -8.4},
                             {0, 0},
                             {1, 8.4},
                             {2, 14.2},
                             {3, 19.4},
                             {4, 22.6},
                             {5, 24.8},
                             {6, 26.6},
                             {7, 27.5}});
  static const Curve behind({{-1, -1},
                             {0, 0},
                             {1, -1},
                             {2, -3.8},
                             {3, -9.2},
                             {4, -15.4},
                             {5, -22},
                             {6, -31.8},
                             {7, -41.8}});
  return {beside(u), behind(u)};
}

}  // namespace

Eigen::Vector3d teeth_point(const HeadVertex& vertex) {
  constexpr double kStep = 0.01;
  const double u = std::abs(vertex.u);
  const Eigen::Vector2d middle = arch(u);
  const Eigen::Vector2d along = (arch(u + kStep) - arch(u)).normalized();
  const Eigen::Vector2d out(-along.y(), along.x());
  const double molar = smooth_step((u - 2.5) / 2);
  const auto blend = [molar](const Around& a, const Around& b) {
    return Around{(1 - molar) * a.out + molar * b.out, (1 - molar) * a.up + molar * b.up};
  };
  const auto point = static_cast<std::size_t>(vertex.v);
  Around around = blend(kIncisor[point], kMolar[point]);
  if (u > kTeeth) around = {-1.5, 8};  // closes the end
  if (u == std::floor(u)) {
    around.out += kBetween[point].out;
    around.up += kBetween[point].up;
  }
  Eigen::Vector2d place = middle + around.out * out;
  // The lower teeth close behind the upper ones, and their gum leans back above the chin.
  if (vertex.rim < 0) {
    around.up *= 0.8;
    place = {0.93 * place.x(), 0.97 * place.y() - 3.5 - square(around.up / 7)};
  }
  const double side = vertex.u < 0 ? -1 : vertex.u > 0;
  return {side * place.x(), kMouthHeight + kEdge + vertex.rim * around.up, kFront + place.y()};
}

Eigen::Vector3d tongue_point(const Eigen::Vector3d& ball) {
  const Eigen::Vector3d center(0, kMouthHeight - 11, 51), radii(16, 6, 22);
  Eigen::Vector3d p = center + radii.cwiseProduct(ball);
  p.y() += 6 * (1 - square(ball.z()));                                // its back is round
  if (ball.y() > 0) p.y() -= 2 * bump(square(p.x() / 8)) * ball.y();  // with a furrow along it
  return p;
}

}  // namespace mimetra::samples
