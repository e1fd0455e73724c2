#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace mimetra::samples {

// The sample's numbers are the same on every machine: its formulas use only operations that IEEE
// 754 rounds exactly (+ - * / and the square root), none of the C library's transcendental
// functions.

constexpr double square(double x) {
  return x * x;
}

/// 0 up to x = 0, 1 from x = 1, with zero slope at both.
constexpr double smooth_step(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * (3 - 2 * x);
}

/// 1 at squared radius 0, exactly 0 from 1, two continuous derivatives.
constexpr double bump(double squared_radius) {
  if (squared_radius >= 1) return 0;
  const double rest = 1 - squared_radius;
  return rest * rest * rest;
}

/// `bump` of an ellipsoid's three radii around `center`.
inline double within(const Eigen::Vector3d& p, const Eigen::Vector3d& center,
                     const Eigen::Vector3d& radii) {
  return bump(((p - center).array() / radii.array()).square().sum());
}

/// A smooth curve through knots, constant beyond the first and the last (cubic Hermite, slopes from
/// the neighbours).
class Curve {
 public:
  struct Knot {
    double x;
    double y;
  };
  /// \pre at least two knots, x ascending
  explicit Curve(std::vector<Knot> knots) : knots_(std::move(knots)) {}
  double operator()(double x) const;

 private:
  double slope(std::size_t knot) const;

  std::vector<Knot> knots_;
};

/// Pushes the surface around a place, as a thumb pushes clay. Lengths in mm.
struct Stroke {
  Eigen::Vector3d center;
  Eigen::Vector3d radii;  ///< nothing moves from there on
  Eigen::Vector3d push;   ///< at the middle
};

/// Where all strokes together move `p`. Each weighs by the place before any of them.
Eigen::Vector3d sculpted(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

/// The same with every stroke that has its middle beside the plane x = 0 made on both sides. A
/// mirrored `p` gives exactly the mirrored result.
Eigen::Vector3d sculpted_on_both_sides(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

}  // namespace mimetra::samples
