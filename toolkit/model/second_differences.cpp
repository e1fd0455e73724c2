#include "toolkit/model/second_differences.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/median.h"

namespace mimetra {

double median_step(const Eigen::VectorXd& times) {
  const double step = median_difference(times);
  if (!(step > 0)) {
    throw std::invalid_argument("smoothness: the median time step is " + std::to_string(step) +
                                " s, expected a positive one");
  }
  return step;
}

SecondDifferences second_differences(const Eigen::VectorXd& times) {
  const double unit = median_step(times);
  SecondDifferences differences(times.size() - 2, 3);
  for (Eigen::Index f = 0; f < differences.rows(); ++f) {
    const double before = (times[f + 1] - times[f]) / unit;
    const double after = (times[f + 2] - times[f + 1]) / unit;
    const double half = (before + after) / 2;
    // The second derivative times the root of the time that it stands for.
    differences.row(f) << 1 / before, -1 / before - 1 / after, 1 / after;
    differences.row(f) *= std::sqrt(half) / half;
  }
  return differences;
}

Eigen::MatrixXd differences_of(const SecondDifferences& differences,
                               const Eigen::MatrixXd& values) {
  const Eigen::Index n = differences.rows();
  return differences.col(0).asDiagonal() * values.topRows(n) +
         differences.col(1).asDiagonal() * values.middleRows(1, n) +
         differences.col(2).asDiagonal() * values.bottomRows(n);
}

}  // namespace mimetra
