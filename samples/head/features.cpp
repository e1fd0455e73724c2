#include "samples/head/features.h"

#include <cmath>

#include "samples/head/curves.h"
#include "samples/head/strokes.h"

namespace mimetra::samples {
namespace {

using Vector = Eigen::Vector3d;

// The bones under the skin, then what sits on the nose. Middle, radii, push.
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

/// An eyebrow as sculptors carve it: a low arc.
double eyebrow(double x, double y) {
  static const Curve arc({{6, 19}, {14, 20.5}, {26, 24}, {34, 25}, {44, 21.5}, {52, 15}});
  static const Curve strength({{6, 0}, {17, 0.8}, {30, 1}, {52, 0}});
  return 2.0 * strength(std::abs(x)) * bump(square((y - arc(std::abs(x))) / 8));
}

/// Two rolls that touch at d = 0.
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

/// The groove from nose to lip, and the dents at the corners of the mouth.
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
  // A section through the ear at one height, from its front to behind it, and how the ear's height
  // scales it.
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

}  // namespace mimetra::samples
