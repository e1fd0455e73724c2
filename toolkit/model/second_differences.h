#pragma once

#include <Eigen/Core>

namespace mimetra {

/// Row f holds the factors of frames f, f + 1 and f + 2 in their second difference over time.
using SecondDifferences = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The middle one of the steps between `times` (F >= 2). Throws std::invalid_argument where it is
/// not positive.
double median_step(const Eigen::VectorXd& times);

/// Divided differences in units of the median step, so that evenly spaced frames have 1, -2, 1 (F -
/// 2 rows): their sum of squares is the integral of the squared second derivative, and a gap bends
/// as easily as its length says. `times` ascend (F >= 3). Throws as median_step.
SecondDifferences second_differences(const Eigen::VectorXd& times);

/// The second differences of F x D values: (F - 2) x D.
Eigen::MatrixXd differences_of(const SecondDifferences& differences, const Eigen::MatrixXd& values);

}  // namespace mimetra
