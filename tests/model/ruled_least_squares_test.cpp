#include "toolkit/model/ruled_least_squares.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"

namespace mimetra {
namespace {

struct RuledProblem {
  Eigen::MatrixXd gram;
  Eigen::VectorXd h;
};

RuledProblem ruled_problem(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(size + 4, size);
  for (double& value : a.reshaped()) value = normal(random);
  Eigen::VectorXd b(size + 4);
  for (double& value : b) value = 2 * normal(random);
  return {a.transpose() * a, a.transpose() * b};
}

double energy(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h, const Eigen::VectorXd& x) {
  return x.dot(gram * x) / 2 - h.dot(x);
}

/// Tries each way of leaving one unknown of each group, or none, and takes the best.
struct Enumeration {
  const RuledLeastSquares& solver;
  const Eigen::VectorXd& h;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best = {};

  void visit(std::size_t group, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
    const UnknownRules& rules = solver.rules();
    if (group == rules.exclusive.size()) {
      const Eigen::VectorXd x = box_least_squares(solver.system(), h, lower, upper);
      const double found = energy(solver.system(), h, x);
      if (found < least) {
        least = found;
        best = x;
      }
      return;
    }
    for (const int chosen : rules.exclusive[group]) {
      Eigen::VectorXd low = lower, high = upper;
      for (const int other : rules.exclusive[group]) {
        if (other != chosen) low[other] = high[other] = rules.off[other];
      }
      visit(group + 1, low, high);
    }
  }
};

UnknownRules two_groups(int size) {
  UnknownRules rules = UnknownRules::box(size);
  rules.exclusive = {{0, 1, 2}, {3, 4}};
  return rules;
}

TEST(RuledLeastSquares, IsTheBoxSolutionWithoutRules) {
  const RuledProblem problem = ruled_problem(8, 1);
  const UnknownRules box = UnknownRules::box(8);
  EXPECT_EQ(RuledLeastSquares(problem.gram, box)(problem.h),
            box_least_squares(problem.gram, problem.h, box.lower, box.upper));
}

TEST(RuledLeastSquares, SatisfiesTheOptimalityConditionsWithPairsAndLimits) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RuledProblem problem = ruled_problem(9, seed);
    UnknownRules rules = UnknownRules::box(9);
    rules.lower[2] = -0.4;
    rules.upper[3] = 0.3;
    rules.lower[4] = rules.upper[4] = 0.2;
    rules.pairs = {{0, 1}, {2, 5}};
    rules.pair_weight = 7;
    Eigen::MatrixXd literal = problem.gram;
    for (const auto& [a, b] : rules.pairs) {
      Eigen::VectorXd difference = Eigen::VectorXd::Zero(9);
      difference[a] = 1;
      difference[b] = -1;
      literal += rules.pair_weight * difference * difference.transpose();
    }
    const Eigen::VectorXd x = RuledLeastSquares(problem.gram, rules)(problem.h);
    // As without rules: rounding times the condition number.
    EXPECT_LT(box_optimality_violation(literal, problem.h, rules.lower, rules.upper, x), 1e-11);
  }
}

TEST(RuledLeastSquares, DrawsPairsTogether) {
  const RuledProblem problem = ruled_problem(6, 3);
  double before = std::numeric_limits<double>::infinity();
  for (const double weight : {0.0, 1.0, 100.0, 1e6}) {
    UnknownRules rules = UnknownRules::box(6);
    rules.pairs = {{1, 4}};
    rules.pair_weight = weight;
    const Eigen::VectorXd x = RuledLeastSquares(problem.gram, rules)(problem.h);
    EXPECT_LE(std::abs(x[1] - x[4]), before + 1e-12);
    before = std::abs(x[1] - x[4]);
  }
  EXPECT_LT(before, 1e-4);
}

TEST(RuledLeastSquares, TakesTheBestOfAllChoicesOfExclusiveGroups) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const RuledProblem problem = ruled_problem(7, seed);
    UnknownRules rules = two_groups(7);
    if (seed % 3 == 1) rules.exclusive.push_back({2, 5});  // one in two groups
    if (seed % 3 == 2) {
      rules.lower[1] = -0.5;  // off within its bounds
      rules.off[3] = 0.25;
    }
    const RuledLeastSquares solver(problem.gram, rules);
    Enumeration all{solver, problem.h};
    all.visit(0, rules.lower, rules.upper);
    const Eigen::VectorXd x = solver(problem.h);
    EXPECT_NEAR(energy(problem.gram, problem.h, x), all.least, 1e-12 * std::abs(all.least)) << seed;
    for (const std::vector<int>& group : rules.exclusive) {
      int moving = 0;
      for (const int unknown : group) moving += x[unknown] != rules.off[unknown];
      EXPECT_LE(moving, 1) << seed;
    }
  }
}

TEST(RuledLeastSquares, TakesTheLowerUnknownOfATie) {
  UnknownRules rules = UnknownRules::box(4);
  rules.exclusive = {{1, 2, 3}};
  Eigen::MatrixXd gram = Eigen::MatrixXd::Identity(4, 4);
  const Eigen::VectorXd x = RuledLeastSquares(gram, rules)(Eigen::Vector4d(0.5, 0.2, 0.7, 0.7));
  EXPECT_EQ(x, Eigen::Vector4d(0.5, 0, 0.7, 0));
}

TEST(RuledLeastSquares, DoesNotDependOnTheStart) {
  const RuledProblem problem = ruled_problem(7, 9);
  const RuledLeastSquares solver(problem.gram, two_groups(7));
  EXPECT_EQ(solver(problem.h), solver(problem.h, Eigen::VectorXd::Constant(7, 0.6)));
}

TEST(RuledLeastSquares, SmoothsWithinItsRules) {
  const RuledProblem problem = ruled_problem(7, 4);
  const RuledLeastSquares solver(problem.gram, two_groups(7));
  Eigen::MatrixXd h(30, 7), single(30, 7);
  for (int f = 0; f < 30; ++f) {
    h.row(f) =
        (problem.gram * (Eigen::VectorXd::Random(7) * 0.6 + Eigen::VectorXd::Constant(7, 0.3)))
            .transpose();
    single.row(f) = solver(h.row(f).transpose()).transpose();
  }
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(30, 0, 29);
  const double mu = problem.gram.diagonal().mean();
  const Eigen::MatrixXd beta = solver.smooth(h, times, mu, single);
  WeightBounds bounds{Eigen::MatrixXd::Zero(30, 7), Eigen::MatrixXd::Ones(30, 7)};
  for (const std::vector<int>& group : solver.rules().exclusive) {
    int chosen = -1;
    for (int f = 0; f < 30; ++f) {
      for (const int unknown : group) {
        if (single(f, unknown) > 0) chosen = unknown;
      }
      if (chosen < 0) continue;
      int moving = 0;
      for (const int unknown : group) {
        moving += beta(f, unknown) > 0;
        if (unknown != chosen) bounds.upper(f, unknown) = 0;
      }
      EXPECT_LE(moving, 1) << f;
    }
    ASSERT_GE(chosen, 0);
  }
  // The first frame of each group has a choice here, so that all bounds are known.
  EXPECT_LT(smooth_optimality_violation({solver.system()}, h, times, mu, beta, bounds), 1e-9);
}

TEST(RuledLeastSquares, RefusesRulesThatDoNotFit) {
  const RuledProblem problem = ruled_problem(4, 1);
  const auto refuse = [&](const UnknownRules& rules) {
    EXPECT_THROW(RuledLeastSquares(problem.gram, rules), std::invalid_argument);
  };
  refuse(UnknownRules::box(5));
  UnknownRules rules = UnknownRules::box(4);
  rules.pairs = {{0, 4}};
  refuse(rules);
  rules = UnknownRules::box(4);
  rules.exclusive = {{0, 1}};
  rules.off[1] = -1;
  refuse(rules);
  rules = UnknownRules::box(4);
  rules.lower[2] = 2;
  refuse(rules);
}

}  // namespace
}  // namespace mimetra
