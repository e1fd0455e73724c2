#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"

namespace mimetra {
namespace {

/// Times whose median step is 1.
Eigen::VectorXd even(Eigen::Index frames) {
  return Eigen::VectorXd::LinSpaced(frames, 0, double(frames - 1));
}

/// The same problem as one dense box problem in F D unknowns.
struct DenseProblem {
  DenseProblem(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& rows, double mu)
      : DenseProblem(std::vector<Eigen::MatrixXd>(rows.rows(), gram), rows, even(rows.rows()), mu) {
  }
  DenseProblem(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& rows,
               const Eigen::VectorXd& times, double mu)
      : system(Eigen::MatrixXd::Zero(rows.size(), rows.size())),
        h(rows.reshaped<Eigen::RowMajor>()),
        lower(Eigen::VectorXd::Zero(rows.size())),
        upper(Eigen::VectorXd::Ones(rows.size())) {
    const Eigen::Index frames = rows.rows(), d = rows.cols();
    for (Eigen::Index f = 0; f < frames; ++f) {
      system.block(f * d, f * d, d, d) = grams[f];
    }
    for (Eigen::Index f = 0; f + 2 < frames; ++f) {
      Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(frames, 1);
      const double before = times[f + 1] - times[f], after = times[f + 2] - times[f + 1];
      // x'' of the parabola through three points, times the root of the time it stands for.
      difference.middleRows<3>(f) << 2 / (before * (before + after)), -2 / (before * after),
          2 / (after * (before + after));
      difference *= std::sqrt((before + after) / 2);
      for (Eigen::Index a = f; a < f + 3; ++a) {
        for (Eigen::Index b = f; b < f + 3; ++b) {
          system.block(a * d, b * d, d, d).diagonal().array() += mu * difference(a) * difference(b);
        }
      }
    }
  }

  double violation(const Eigen::MatrixXd& beta) const {
    return box_optimality_violation(system, h, lower, upper, beta.reshaped<Eigen::RowMajor>());
  }

  Eigen::MatrixXd system;
  Eigen::VectorXd h, lower, upper;
};

struct Clip {
  Eigen::MatrixXd gram, h;
  double mean_diagonal() const { return gram.diagonal().mean(); }
};

/// Uniform in [-1, 1], the same in every run.
Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(generator); });
}

/// Right-hand sides of weights that jump from frame to frame and go beyond the box.
Clip noisy_clip(int frames, int d) {
  const Eigen::MatrixXd columns = random(20 * d, d);
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const Eigen::MatrixXd weights = (0.8 * random(frames, d)).array() + 0.5;
  return {gram, weights * gram};
}

Eigen::MatrixXd smooth(const Clip& clip, double mu) {
  return smooth_weights({clip.gram}, clip.h, even(clip.h.rows()), mu,
                        Eigen::MatrixXd::Zero(clip.h.rows(), clip.h.cols()));
}

TEST(SmoothWeights, AreTheSolutionOfTheDenseProblem) {
  for (const int frames : {3, 4, 5, 15}) {  // odd and even: the last block holds one frame or two
    const Clip clip = noisy_clip(frames, 4);
    for (const double factor : {1e-3, 1.0, 1e3}) {
      const double mu = factor * clip.mean_diagonal();
      const DenseProblem dense(clip.gram, clip.h, mu);
      const Eigen::MatrixXd expected =
          box_least_squares(dense.system, dense.h, dense.lower, dense.upper)
              .reshaped<Eigen::RowMajor>(frames, 4);
      // Both are exact to rounding times the condition number, at most 1e6 here.
      EXPECT_LT((smooth(clip, mu) - expected).cwiseAbs().maxCoeff(), 1e-9)
          << frames << ' ' << factor;
    }
  }
}

TEST(SmoothWeights, TakeAGramMatrixForEachFrame) {
  const Clip clip = noisy_clip(7, 4);
  std::vector<Eigen::MatrixXd> grams;
  grams.reserve(7);
  for (int f = 0; f < 7; ++f) grams.push_back((0.5 + 0.3 * f) * noisy_clip(3 + f, 4).gram);
  const double mu = clip.mean_diagonal();
  const Eigen::MatrixXd beta =
      smooth_weights(grams, clip.h, even(7), mu, Eigen::MatrixXd::Zero(7, 4));
  EXPECT_LT(DenseProblem(grams, clip.h, even(7), mu).violation(beta), 1e-9);
}

TEST(SmoothWeights, TakeGapsAsLongAsTheyAre) {
  const Clip clip = noisy_clip(8, 4);
  Eigen::VectorXd times(8);
  times << 0, 1, 2, 3, 23, 24, 24.5, 26;
  const double mu = clip.mean_diagonal();
  const Eigen::MatrixXd beta =
      smooth_weights({clip.gram}, clip.h, times, mu, Eigen::MatrixXd::Zero(8, 4));
  const std::vector<Eigen::MatrixXd> grams(8, clip.gram);
  EXPECT_LT(DenseProblem(grams, clip.h, times, mu).violation(beta), 1e-9);
  EXPECT_GT(DenseProblem(grams, clip.h, even(8), mu).violation(beta), 1e-3);
}

TEST(SmoothWeights, KnowNothingOfTheUnitOfTime) {
  const Clip clip = noisy_clip(6, 4);
  Eigen::VectorXd times(6);
  times << 0, 1, 2, 5, 6, 7;
  const auto smooth_at = [&](const Eigen::VectorXd& when) {
    return smooth_weights({clip.gram}, clip.h, when, clip.mean_diagonal(), clip.h);
  };
  EXPECT_LT((smooth_at(times) - smooth_at(times / 30)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SmoothWeights, RefuseAnotherNumberOfGramMatrices) {
  const Clip clip = noisy_clip(5, 4);
  EXPECT_THROW(smooth_weights({clip.gram, clip.gram}, clip.h, even(5), 1, clip.h),
               std::invalid_argument);
}

TEST(SmoothWeights, SatisfyTheOptimalityConditionsOnALongClip) {
  const Clip clip = noisy_clip(100, 12);
  for (const double factor : {0.04, 1.0, 50.0}) {
    const double mu = factor * clip.mean_diagonal();
    EXPECT_LT(DenseProblem(clip.gram, clip.h, mu).violation(smooth(clip, mu)), 1e-9) << factor;
  }
}

TEST(SmoothWeights, SatisfyTheOptimalityConditionsOfASingularGramMatrix) {
  Clip clip = noisy_clip(20, 4);
  clip.gram = clip.gram.replicate(2, 2).eval();
  clip.h = clip.h.replicate(1, 2).eval();
  EXPECT_LT(DenseProblem(clip.gram, clip.h, 1).violation(smooth(clip, 1)), 1e-9);
}

TEST(SmoothWeights, LeaveAStraightLineAsItIs) {
  Clip clip = noisy_clip(20, 3);
  Eigen::MatrixXd line(20, 3);
  for (int f = 0; f < 20; ++f) line.row(f) << 0.1 + 0.03 * f, 0.9 - 0.04 * f, 0.5;
  clip.h = line * clip.gram;
  // The penalty is 0 on straight lines, so they stay the minimum. Rounding x condition number.
  EXPECT_LT((smooth(clip, 100 * clip.mean_diagonal()) - line).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SmoothWeights, AreExactlyZeroWhereNothingPulls) {
  Clip clip = noisy_clip(8, 3);
  clip.h.setZero();
  EXPECT_EQ(smooth(clip, 1), Eigen::MatrixXd::Zero(8, 3));
}

TEST(SmoothWeights, AreTheSingleFramesWhereThereAreTooFew) {
  const Clip clip = noisy_clip(2, 3);
  const Eigen::MatrixXd single = random(2, 3).cwiseAbs();
  EXPECT_EQ(smooth_weights({clip.gram}, clip.h, even(clip.h.rows()), 1, single), single);
}

TEST(SmoothWeights, KeepBoundsOfEachFrameAndGivenWeights) {
  const Clip clip = noisy_clip(25, 4);
  WeightBounds bounds{Eigen::MatrixXd::Zero(25, 4), Eigen::MatrixXd::Ones(25, 4)};
  bounds.lower.col(0).setConstant(-0.5);
  bounds.upper.col(1).setConstant(0.4);
  for (int f = 5; f < 15; ++f) bounds.lower(f, 2) = bounds.upper(f, 2) = 0.3;
  for (const double factor : {0.1, 10.0}) {
    const double mu = factor * clip.mean_diagonal();
    const Eigen::MatrixXd beta = smooth_weights({clip.gram}, clip.h, even(25), mu, clip.h, bounds);
    EXPECT_LT(smooth_optimality_violation({clip.gram}, clip.h, even(25), mu, beta, bounds), 1e-9);
    DenseProblem dense(clip.gram, clip.h, mu);
    dense.lower = bounds.lower.reshaped<Eigen::RowMajor>();
    dense.upper = bounds.upper.reshaped<Eigen::RowMajor>();
    EXPECT_LT(dense.violation(beta), 1e-9);
    EXPECT_EQ(beta.col(2).segment(5, 10), Eigen::VectorXd::Constant(10, 0.3));
  }
}

TEST(SmoothWeights, ConvergeWherePenaltiesAreFarAboveTheData) {
  // A second at 60 frames a second and beyond: what is left of the penalty in a residual is
  // rounding, which grows with it and must not be waited for.
  const Clip clip = noisy_clip(120, 6);
  for (const double frames : {30.0, 60.0, 240.0}) {
    const double mu = std::pow(frames, 4) * clip.mean_diagonal();
    const Eigen::MatrixXd beta = smooth(clip, mu);
    const double rounding = 16 * mu * std::numeric_limits<double>::epsilon() * 16;
    EXPECT_LT(smooth_optimality_violation({clip.gram}, clip.h, even(120), mu, beta),
              1e-9 + rounding / clip.h.lpNorm<Eigen::Infinity>())
        << frames;
  }
}

TEST(SmoothWeights, KnowWhichBoundsHoldInNoiseUnderAStiffPenalty) {
  // Noise about 0, a second at 60 frames a second: weights leave their bounds by 1e-9 to 1e-3, and
  // exchanging all that are on the wrong side may go in circles.
  for (const unsigned seed : {1, 2, 7, 15, 16, 18}) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto drawn = [&](Eigen::Index rows, Eigen::Index columns) -> Eigen::MatrixXd {
      return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(generator); });
    };
    const Eigen::MatrixXd columns = drawn(60, 3);
    Clip clip{columns.transpose() * columns, {}};
    clip.h = 0.3 * drawn(40, 3) * clip.gram;
    const double mu = std::pow(60, 4) * clip.mean_diagonal();
    const Eigen::MatrixXd beta = smooth(clip, mu);
    const DenseProblem dense(clip.gram, clip.h, mu);
    const Eigen::MatrixXd expected =
        box_least_squares(dense.system, dense.h, dense.lower, dense.upper)
            .reshaped<Eigen::RowMajor>(40, 3);
    // Rows of the penalty add up to 16 mu, and a weight is known to half an epsilon.
    const double rounding = 16 * mu * std::numeric_limits<double>::epsilon() / 2;
    EXPECT_LT(dense.violation(beta), 1e-9 + rounding / dense.h.lpNorm<Eigen::Infinity>()) << seed;
    // What such a residual moves weights by, the penalty aside.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(clip.gram);
    EXPECT_LT((beta - expected).cwiseAbs().maxCoeff(), rounding / spectrum.eigenvalues()[0])
        << seed;
  }
}

TEST(SmoothWeights, RefuseBoundsThatDoNotFit) {
  const Clip clip = noisy_clip(5, 4);
  const auto with = [&](const WeightBounds& bounds) {
    smooth_weights({clip.gram}, clip.h, even(5), 1, clip.h, bounds);
  };
  EXPECT_THROW(with({Eigen::MatrixXd::Zero(4, 4), {}}), std::invalid_argument);
  EXPECT_THROW(with({Eigen::MatrixXd::Constant(5, 4, 2), {}}), std::invalid_argument);
}

TEST(SmoothWeights, KnowTheViolationOfTheDenseProblem) {
  const Clip clip = noisy_clip(12, 4);
  const Eigen::MatrixXd beta = (random(12, 4).array() * 0.6 + 0.5).cwiseMax(0).cwiseMin(1);
  const DenseProblem dense(clip.gram, clip.h, 3);
  EXPECT_NEAR(smooth_optimality_violation({clip.gram}, clip.h, even(12), 3, beta),
              dense.violation(beta), 1e-12);
}

TEST(SmoothnessPenalty, IsTheFourthPowerOfTheTimeConstantInFrames) {
  Eigen::VectorXd times(5);
  times << 0, 0.04, 0.08, 0.12, 5;  // one gap does not change the frame rate of the rest
  EXPECT_DOUBLE_EQ(smoothness_penalty(0.08, times, 3), 16 * 3);
}

TEST(SmoothnessPenalty, RefusesTimesThatDoNotPass) {
  EXPECT_THROW(smoothness_penalty(0.1, Eigen::VectorXd::Zero(4), 1), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
