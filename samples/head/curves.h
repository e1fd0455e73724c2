#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace mimetra::samples {

// The sample has the same numbers on every machine. Its formulas use only operations that IEEE 754
// rounds exactly (+ - * / and the square root), and no transcendental functions of the C library.

constexpr double square(double x) {
  return x * x;
}

/// Rises from 0 at x <= 0 to 1 at x >= 1, with zero slope at both.
constexpr double smooth_step(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * (3 - 2 * x);
}

/// Falls from 1 at squared radius 0 to exactly 0 from 1 on, with two continuous derivatives.
constexpr double bump(double squared_radius) {
  if (squared_radius >= 1) return 0;
  const double rest = 1 - squared_radius;
  return rest * rest * rest;
}

/// Value of bump() in an ellipsoid with three `radii` around `center`.
inline double within(const Eigen::Vector3d& p, const Eigen::Vector3d& center,
                     const Eigen::Vector3d& radii) {
  return bump(((p - center).array() / radii.array()).square().sum());
}

/// Smooth curve through knots, constant beyond the first and the last: a cubic Hermite spline with
/// slopes from the neighbouring knots.
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

/// Push of the surface around a place, as a thumb pushes clay. Lengths are in mm.
struct Stroke {
  Eigen::Vector3d center;
  Eigen::Vector3d radii;  ///< distance from which nothing moves, along each axis
  Eigen::Vector3d push;   ///< displacement at the center
};

/// Position of `p` after all strokes. Each stroke is weighted at the original position.
Eigen::Vector3d sculpted(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

/// Applies strokes as sculpted(), on both sides if their center is beside the plane x = 0. A
/// mirrored `p` gives exactly the mirrored result.
Eigen::Vector3d sculpted_on_both_sides(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

}  // namespace mimetra::samples
