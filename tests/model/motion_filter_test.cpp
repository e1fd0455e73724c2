#include "toolkit/model/smoothness.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "toolkit/model/smooth_weights.h"

namespace mimetra {
namespace {

Frames noise(Eigen::Index frames, Eigen::Index coordinates) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  return Frames::NullaryExpr(frames, coordinates, [&] { return normal(generator); });
}

Eigen::VectorXd whole_seconds(Eigen::Index frames) {
  return Eigen::VectorXd::LinSpaced(frames, 0, static_cast<double>(frames - 1));
}

/// (I + mu D^T D)^-1 x with D, the divided second differences, written out as a dense matrix.
Eigen::MatrixXd literal(const Eigen::MatrixXd& x, const Eigen::VectorXd& times, double mu) {
  const Eigen::Index frames = x.rows();
  const double unit = median_step(times);
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(frames - 2, frames);
  for (Eigen::Index f = 0; f + 2 < frames; ++f) {
    const double before = (times[f + 1] - times[f]) / unit;
    const double after = (times[f + 2] - times[f + 1]) / unit;
    d.block<1, 3>(f, f) << 2 / (before * (before + after)), -2 / (before * after),
        2 / (after * (before + after));
    d.row(f) *= std::sqrt((before + after) / 2);
  }
  const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(frames, frames) + mu * d.transpose() * d;
  return system.lu().solve(x);
}

TEST(MotionFilter, SolvesTheDenseProblem) {
  for (const Eigen::Index frames : {3, 4, 5, 40}) {
    for (const double smoothness : {0.3, 1.0, 5.0}) {
      const Frames x = noise(frames, 7);
      const Eigen::VectorXd times = whole_seconds(frames);
      const Frames y = MotionFilter(times, smoothness)(x);
      // Condition number 1 + 16 mu, at most 1e4.
      EXPECT_LT((y - literal(x, times, std::pow(smoothness, 4))).cwiseAbs().maxCoeff(), 1e-11)
          << frames << ' ' << smoothness;
    }
  }
}

TEST(MotionFilter, TakesGapsAsLongAsTheyAre) {
  Eigen::VectorXd times(9);
  times << 0, 1, 2, 3, 23, 24, 24.5, 26, 27;
  const Frames x = noise(9, 3);
  const Eigen::MatrixXd expected = literal(x, times, 16);
  EXPECT_LT((MotionFilter(times, 2)(x) - expected).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_GT((MotionFilter(whole_seconds(9), 2)(x) - expected).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(MotionFilter, KnowsNothingOfTheUnitOfTime) {
  const Frames x = noise(30, 2);
  const Eigen::VectorXd times = whole_seconds(30);
  EXPECT_LT(
      (MotionFilter(times, 3)(x) - MotionFilter(times / 60, 3.0 / 60)(x)).cwiseAbs().maxCoeff(),
      1e-12);
}

TEST(MotionFilter, LeavesWhatDoesNotMoveBitByBit) {
  const Eigen::VectorXd times = (whole_seconds(20) / 30).cwiseSqrt();
  const Frames still = noise(1, 50).replicate(20, 1);
  EXPECT_EQ(MotionFilter(times, 0.7)(still), still);
}

TEST(MotionFilter, LeavesMotionAlongAStraightLineAsItIs) {
  // Multiples of 1/8 at whole seconds have no rounding.
  const Frames start = (8 * noise(1, 40)).array().round() / 8;
  const Frames step = (8 * noise(1, 80).rightCols(40)).array().round() / 8;
  const Frames line = start.replicate(20, 1) + whole_seconds(20) * step;
  EXPECT_EQ(MotionFilter(whole_seconds(20), 4)(line), line);
}

TEST(MotionFilter, KeepsMeanAndTrend) {
  const Frames x = noise(50, 5);
  const Eigen::VectorXd times = whole_seconds(50);
  const Eigen::MatrixXd change = MotionFilter(times, 6)(x) - x;
  // Rounding of 50 terms of up to 50.
  EXPECT_LT(change.colwise().sum().cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((times.transpose() * change).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MotionFilter, GoesToTheStraightLineThatFitsBest) {
  const Frames x = noise(30, 4);
  const Eigen::VectorXd times = whole_seconds(30);
  Eigen::MatrixXd lines(30, 2);
  lines << Eigen::VectorXd::Ones(30), times;
  const Eigen::MatrixXd fitted =
      lines * (lines.transpose() * lines).inverse() * lines.transpose() * x;
  // 1 / mu is 0 beside the least eigenvalue, about (pi / 30)^4; rounding times its inverse, 1e4.
  EXPECT_LT((MotionFilter(times, 1e9)(x) - fitted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MotionFilter, LeavesOneOrTwoFramesAndNoSmoothnessAsTheyAre) {
  for (const Eigen::Index frames : {1, 2}) {
    const Frames x = noise(frames, 6);
    EXPECT_EQ(MotionFilter(Eigen::VectorXd::Zero(frames), 1)(x), x);
  }
  const Frames x = noise(10, 6);
  EXPECT_EQ(MotionFilter(whole_seconds(10), 0)(x), x);
}

TEST(MotionFilter, GivesTheSameBytesForAnyThreads) {
  const Frames x = noise(33, 211);
  const MotionFilter filter(whole_seconds(33), 2);
  EXPECT_EQ(filter(x, Context().with_threads(1)), filter(x, Context().with_threads(3)));
}

TEST(MotionFilter, KeepsEqualMotionsEqualBitByBit) {
  Frames x = noise(20, 100);
  x.col(97) = x.col(3);
  const Frames y = MotionFilter(whole_seconds(20), 2)(x);
  EXPECT_EQ(y.col(97), y.col(3));
}

TEST(MotionFilter, RefusesOtherFramesAndTimesThatDoNotPass) {
  EXPECT_THROW(MotionFilter(whole_seconds(5), 1)(noise(4, 3)), std::invalid_argument);
  EXPECT_THROW(MotionFilter(Eigen::VectorXd::Zero(5), 1), std::invalid_argument);
  EXPECT_THROW(MotionFilter(whole_seconds(5), -1), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
