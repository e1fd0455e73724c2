#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// Median of n >= 1 values, none of them NaN; for even n the upper of the two in the middle.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Median of the differences between consecutive values. \pre n >= 2
inline double median_difference(const Eigen::VectorXd& values) {
  std::vector<double> differences;
  differences.reserve(static_cast<std::size_t>(values.size()));
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    differences.push_back(values[i] - values[i - 1]);
  }
  return median(std::move(differences));
}

}  // namespace mimetra
