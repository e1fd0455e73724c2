#include "toolkit/model/box_least_squares.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/cache_sizes.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A problem whose minimum is outside of the unit box in many directions; its condition number is
/// below 1e4.
struct BoxProblem {
  BoxProblem(int size, int rows, unsigned seed)
      : lower(Eigen::VectorXd::Zero(size)), upper(Eigen::VectorXd::Ones(size)) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd a(rows, size);
    for (double& value : a.reshaped()) value = normal(random);
    Eigen::VectorXd b(rows);
    for (double& value : b) value = 20 * normal(random);
    gram = a.transpose() * a;
    gram.diagonal().array() += 0.02 * gram.diagonal().mean();
    h = a.transpose() * b;
  }

  Eigen::VectorXd solved(const Eigen::VectorXd& start = {}) const {
    return block_pivoting(gram, h, lower, upper, start);
  }

  Eigen::MatrixXd gram;
  Eigen::VectorXd h, lower, upper;
};

TEST(BlockPivoting, SatisfiesTheOptimalityConditions) {
  for (const int size : {1, 2, 7, 40, 300}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      const BoxProblem problem(size, size + 3, seed);
      // The condition number times the rounding of sums of 300 terms.
      EXPECT_LT(box_optimality_violation(problem.gram, problem.h, problem.lower, problem.upper,
                                         problem.solved()),
                1e-11)
          << size << ' ' << seed;
    }
  }
}

TEST(BlockPivoting, FindsWhatOneExchangeAtATimeFinds) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const BoxProblem problem(50, 45, seed);
    const Eigen::VectorXd expected =
        box_least_squares(problem.gram, problem.h, problem.lower, problem.upper);
    EXPECT_LT((problem.solved() - expected).lpNorm<Eigen::Infinity>(), 1e-10) << seed;
    // Both kinds of bounds are met, or the comparison would say little.
    EXPECT_GT((expected.array() == 0).count(), 3);
    EXPECT_GT((expected.array() == 1).count(), 3);
  }
}

TEST(BlockPivoting, DoesNotDependOnTheStart) {
  const BoxProblem problem(60, 70, 3);
  const Eigen::VectorXd cold = problem.solved();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  for (int round = 0; round < 5; ++round) {
    const Eigen::VectorXd start = Eigen::VectorXd::NullaryExpr(60, [&] { return uniform(random); });
    EXPECT_LT((problem.solved(start) - cold).lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

TEST(BlockPivoting, SolvesASingularProblemAsTheOtherDoes) {
  BoxProblem problem(6, 9, 4);
  problem.gram.row(5).setZero();
  problem.gram.col(5).setZero();
  problem.h[5] = 0;
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(6, 0.5);
  EXPECT_LT(box_optimality_violation(problem.gram, problem.h, problem.lower, problem.upper,
                                     problem.solved(start)),
            1e-11);
}

TEST(BlockPivoting, StaysWhereBoundsMeet) {
  BoxProblem problem(8, 12, 5);
  problem.lower[3] = problem.upper[3] = 0.25;
  EXPECT_EQ(problem.solved()[3], 0.25);
  EXPECT_LT(box_optimality_violation(problem.gram, problem.h, problem.lower, problem.upper,
                                     problem.solved()),
            1e-11);
}

TEST(BlockPivoting, RefusesWhatTheOtherRefuses) {
  const BoxProblem problem(4, 6, 6);
  EXPECT_THAT(
      [&] { block_pivoting(problem.gram, problem.h.head(3), problem.lower, problem.upper); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("the sizes disagree")));
  EXPECT_THAT([&] { block_pivoting(problem.gram, problem.h, problem.upper, problem.lower); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("lower bound is above")));
  BoxProblem endless = problem;
  endless.h[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { endless.solved(); }, ThrowsMessage<std::runtime_error>(HasSubstr("finite")));
}

TEST(BlockPivoting, HasTheSameBytesOnEveryProcessor) {
  // The blocks of its factor are longer than what the smallest cache takes at once. Its minimum is
  // inside of the box, so that one pass with all unknowns finds it.
  constexpr int kSize = 1040;
  BoxProblem problem(1, 1, 7);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  problem.gram = Eigen::MatrixXd::NullaryExpr(kSize, kSize, [&] { return uniform(random); });
  problem.gram += problem.gram.transpose().eval();
  problem.gram.diagonal().array() += 2 * kSize;
  const Eigen::VectorXd inside = Eigen::VectorXd::Constant(kSize, 0.5);
  problem.h = problem.gram * inside;
  problem.lower = Eigen::VectorXd::Zero(kSize);
  problem.upper = Eigen::VectorXd::Ones(kSize);
  test::expect_equal_bytes_on_each_processor(
      [&] { return Eigen::MatrixXd(problem.solved(inside)); });
}

}  // namespace
}  // namespace mimetra
