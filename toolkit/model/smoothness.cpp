#include "toolkit/model/smoothness.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/median.h"
#include "toolkit/mesh/parallel.h"

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
    // Second derivative times the square root of the time that the row represents.
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

double smoothness_penalty(double smoothness, const Eigen::VectorXd& times, double mean_diagonal) {
  if (times.size() < 2) return 0;
  return std::pow(smoothness / median_step(times), 4) * mean_diagonal;
}

MotionFilter::MotionFilter(const Eigen::VectorXd& times, double smoothness)
    : frames_(times.size()) {
  if (!(smoothness >= 0)) {
    throw std::invalid_argument("smoothness is " + std::to_string(smoothness) +
                                "; it must be from 0");
  }
  if (frames_ < 3 || smoothness == 0) return;
  acts_ = true;
  differences_ = second_differences(times);
  const double share = 1 / smoothness_penalty(smoothness, times, 1);
  const Eigen::Index n = differences_.rows();
  pivots_.resize(n);
  first_ = second_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = differences_.row(i);
    pivots_[i] = row.squaredNorm() + share;
    if (i >= 1) pivots_[i] -= first_[i - 1] * first_[i - 1] * pivots_[i - 1];
    if (i >= 2) pivots_[i] -= second_[i - 2] * second_[i - 2] * pivots_[i - 2];
    if (i + 1 < n) {
      const auto next = differences_.row(i + 1);
      double entry = row[1] * next[0] + row[2] * next[1];
      if (i >= 1) entry -= second_[i - 1] * first_[i - 1] * pivots_[i - 1];
      first_[i] = entry / pivots_[i];
    }
    if (i + 2 < n) second_[i] = row[2] * differences_(i + 2, 0) / pivots_[i];
  }
}

Frames MotionFilter::operator()(Frames frames, const Context& context) const {
  if (frames.rows() != frames_) {
    throw std::invalid_argument(std::to_string(frames.rows()) + " frames, expected " +
                                std::to_string(frames_) + ", one for each time");
  }
  if (!acts_) return frames;
  const auto blocks = static_cast<int>((frames.cols() + kCoordinates - 1) / kCoordinates);
  const auto smooth_block = [&](int block) {
    const Eigen::Index first = Eigen::Index{block} * kCoordinates;
    const auto count = std::min<Eigen::Index>(kCoordinates, frames.cols() - first);
    Block x = Block::Zero(frames_, kCoordinates);
    x.leftCols(count) = frames.middleCols(first, count);
    smooth(x);
    frames.middleCols(first, count) = x.leftCols(count);
  };
  parallel_for(blocks, smooth_block, context);
  return frames;
}

void MotionFilter::smooth(Block& x) const {
  const Eigen::Index n = differences_.rows();
  const auto before = [this](Eigen::Index i) { return differences_(i, 0); };
  const auto after = [this](Eigen::Index i) { return differences_(i, 2); };
  Block u(n, kCoordinates);
  // Steps are computed first, so that they are exactly 0 for coordinates that do not move.
  for (Eigen::Index i = 0; i < n; ++i) {
    u.row(i) = after(i) * (x.row(i + 2) - x.row(i + 1)) - before(i) * (x.row(i + 1) - x.row(i));
    if (i >= 1) u.row(i) -= first_[i - 1] * u.row(i - 1);
    if (i >= 2) u.row(i) -= second_[i - 2] * u.row(i - 2);
  }
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    u.row(i) /= pivots_[i];
    if (i + 1 < n) u.row(i) -= first_[i] * u.row(i + 1);
    if (i + 2 < n) u.row(i) -= second_[i] * u.row(i + 2);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    x.row(i) -= before(i) * u.row(i);
    x.row(i + 1) += (before(i) + after(i)) * u.row(i);
    x.row(i + 2) -= after(i) * u.row(i);
  }
}

}  // namespace mimetra
