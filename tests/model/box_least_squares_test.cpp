#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "toolkit/model/box_least_squares.h"

namespace mimetra {
namespace {

struct Problem {
  Eigen::MatrixXd gram;
  Eigen::VectorXd h;
};

/// A consistent least-squares problem of `rank` with its minimum partly outside of the box.
Problem random_problem(int size, int rank, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(rank, size);
  for (double& value : a.reshaped()) value = normal(random);
  Eigen::VectorXd b(rank);
  for (double& value : b) value = 2 * normal(random);
  return {a.transpose() * a, a.transpose() * b};
}

double objective(const Problem& problem, const Eigen::VectorXd& x) {
  return 0.5 * x.dot(problem.gram * x) - problem.h.dot(x);
}

/// Tries every choice of lower, free and upper.
double least_by_enumeration(const Problem& problem) {
  const int n = static_cast<int>(problem.h.size());
  double least = 0;
  for (int code = 0; code < std::pow(3, n); ++code) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    std::vector<int> free;
    for (int j = 0, rest = code; j < n; ++j, rest /= 3) {
      if (rest % 3 == 1) x[j] = 1;
      if (rest % 3 == 2) free.push_back(j);
    }
    if (!free.empty()) {
      const Eigen::VectorXd right = (problem.h - problem.gram * x)(free);
      const Eigen::MatrixXd system = problem.gram(free, free);
      x(free) = system.completeOrthogonalDecomposition().solve(right).eval();
    }
    if (x.minCoeff() >= 0 && x.maxCoeff() <= 1) least = std::min(least, objective(problem, x));
  }
  return least;
}

TEST(BoxLeastSquares, SatisfiesTheOptimalityConditions) {
  for (int size = 1; size <= 60; ++size) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      const Problem problem = random_problem(size, 2 * size + 3, seed);
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size), one = Eigen::VectorXd::Ones(size);
      const Eigen::VectorXd x = box_least_squares(problem.gram, problem.h, zero, one);
      // The condition number is below 1e3: rounding leaves about 1e3 x 1e-16 x size.
      EXPECT_LT(box_optimality_violation(problem.gram, problem.h, zero, one, x), 1e-11)
          << size << ' ' << seed;
    }
  }
}

TEST(BoxLeastSquares, IsAsGoodAsTheBestOfAllActiveSets) {
  for (int size = 1; size <= 6; ++size) {
    for (unsigned seed = 0; seed < 8; ++seed) {
      const Problem problem = random_problem(size, size + 3, 100 + seed);
      const Eigen::VectorXd x = box_least_squares(
          problem.gram, problem.h, Eigen::VectorXd::Zero(size), Eigen::VectorXd::Ones(size));
      const double least = least_by_enumeration(problem);
      EXPECT_NEAR(objective(problem, x), least, 1e-12 * std::abs(least)) << size << ' ' << seed;
    }
  }
}

TEST(BoxLeastSquares, SatisfiesTheOptimalityConditionsOfSingularSystems) {
  for (const int size : {2, 6, 12, 30, 60}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Problem problem = random_problem(size, size / 2, seed);
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size), one = Eigen::VectorXd::Ones(size);
      const Eigen::VectorXd x = box_least_squares(problem.gram, problem.h, zero, one);
      // The orthogonal decomposition drops what is below 1e-14 of the largest pivot.
      EXPECT_LT(box_optimality_violation(problem.gram, problem.h, zero, one, x), 1e-10)
          << size << ' ' << seed;
    }
  }
}

TEST(BoxLeastSquares, EndsWhereColumnsOccurTwice) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem once = random_problem(8, 12, seed);
    const Problem twice = {once.gram.replicate(2, 2), once.h.replicate(2, 1)};
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(16), one = Eigen::VectorXd::Ones(16);
    const Eigen::VectorXd x =
        box_least_squares(twice.gram, twice.h, zero, one, Eigen::VectorXd::Constant(16, 0.5));
    EXPECT_LT(box_optimality_violation(twice.gram, twice.h, zero, one, x), 1e-11) << seed;
  }
}

TEST(BoxLeastSquares, SatisfiesTheOptimalityConditionsOfIllConditionedSystems) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Problem problem = random_problem(20, 40, seed);
    // Columns of length 1 to 1e-6: the condition number is about 1e12.
    const Eigen::VectorXd scales = Eigen::pow(10, -Eigen::ArrayXd::LinSpaced(20, 0, 6));
    problem.gram = scales.asDiagonal() * problem.gram * scales.asDiagonal();
    problem.h = scales.asDiagonal() * problem.h;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(20), one = Eigen::VectorXd::Ones(20);
    const Eigen::VectorXd x = box_least_squares(problem.gram, problem.h, zero, one);
    EXPECT_LT(box_optimality_violation(problem.gram, problem.h, zero, one, x), 1e-12) << seed;
  }
}

TEST(BoxLeastSquares, IsExactlyZeroWithoutAPullFromAnyStart) {
  const Problem problem = random_problem(7, 12, 3);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(7), one = Eigen::VectorXd::Ones(7);
  for (const double start : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(box_least_squares(problem.gram, zero, zero, one, Eigen::VectorXd::Constant(7, start)),
              zero);
  }
}

TEST(BoxLeastSquares, DoesNotDependOnTheStart) {
  const Problem problem = random_problem(20, 40, 7);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(20), one = Eigen::VectorXd::Ones(20);
  const Eigen::VectorXd cold = box_least_squares(problem.gram, problem.h, zero, one);
  for (const double start : {-3.0, 0.2, 0.5, 1.0, 8.0}) {
    const Eigen::VectorXd warm =
        box_least_squares(problem.gram, problem.h, zero, one, Eigen::VectorXd::Constant(20, start));
    // Rounding times the condition number of about 1e2.
    EXPECT_LT((warm - cold).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(BoxLeastSquares, KeepsVariablesWhoseBoundsMeet) {
  const Problem problem = random_problem(4, 8, 5);
  Eigen::VectorXd upper = Eigen::VectorXd::Ones(4);
  upper[2] = 0;
  const Eigen::VectorXd x =
      box_least_squares(problem.gram, problem.h, Eigen::VectorXd::Zero(4), upper);
  EXPECT_EQ(x[2], 0);
}

TEST(BoxLeastSquares, RefusesOtherSizesCrossedBoundsAndWhatIsNotFinite) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3), one = Eigen::VectorXd::Ones(3);
  Problem problem = random_problem(3, 5, 1);
  EXPECT_THROW(box_least_squares(problem.gram, problem.h, zero.head(2), one),
               std::invalid_argument);
  EXPECT_THROW(box_least_squares(problem.gram, problem.h, one, zero), std::invalid_argument);
  problem.h[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(box_least_squares(problem.gram, problem.h, zero, one), std::runtime_error);
}

TEST(BoxOptimalityViolation, SeesAWrongSolution) {
  const Problem problem = random_problem(5, 9, 3);
  EXPECT_GT(box_optimality_violation(problem.gram, problem.h, Eigen::VectorXd::Zero(5),
                                     Eigen::VectorXd::Ones(5), Eigen::VectorXd::Constant(5, 0.5)),
            1e-3);
}

}  // namespace
}  // namespace mimetra
