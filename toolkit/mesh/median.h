#pragma once

#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// The median of n >= 1 values, none of them NaN: the upper of two in the middle.
double median(std::vector<double> values);

/// The median of what n >= 2 values differ by from one to the next.
double median_difference(const Eigen::VectorXd& values);

}  // namespace mimetra
