#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace mimetra {

/// Whether `Integer` holds all values, rounded to whole numbers; false where one is not finite.
template <typename Integer>
bool all_are_held_by(const Eigen::MatrixXd& values) {
  const double limit = std::ldexp(1.0, std::numeric_limits<Integer>::digits);
  return (values.array().round() >= -limit && values.array().round() < limit).all();
}

}  // namespace mimetra
