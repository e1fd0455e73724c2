#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <mimetra/transfer/row_solver.h>

namespace mimetra {
namespace {

/// Sparse, symmetric, and its diagonal outweighs the rest: a condition number below 10.
Eigen::SparseMatrix<double> random_system(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::uniform_int_distribution<int> index(0, size - 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    const int other = index(random);
    const double value = uniform(random);
    entries.emplace_back(i, i, 3);
    entries.emplace_back(i, i, std::abs(value));
    entries.emplace_back(other, other, std::abs(value));
    entries.emplace_back(i, other, value);
    entries.emplace_back(other, i, value);
  }
  Eigen::SparseMatrix<double> system(size, size);
  system.setFromTriplets(entries.begin(), entries.end());
  return system;
}

TEST(RowSolver, AgreesWithADenseSolve) {
  for (const int size : {1, 2, 7, 60}) {
    const Eigen::SparseMatrix<double> system = random_system(size, 4);
    const RowSolver solver(system);
    const RowSolver::Rows right = RowSolver::Rows::Random(size, RowSolver::kWidth);
    const RowSolver::Rows expected = Eigen::MatrixXd(system).ldlt().solve(right);
    RowSolver::Rows ordered(size, RowSolver::kWidth);
    for (int i = 0; i < size; ++i) ordered.row(solver.order()[i]) = right.row(i);
    const RowSolver::Rows found = solver.solve(ordered);
    for (int i = 0; i < size; ++i) {
      EXPECT_LT((found.row(solver.order()[i]) - expected.row(i)).norm(), 1e-13) << size;
    }
  }
}

TEST(RowSolver, SolvesNothing) {
  const RowSolver solver(Eigen::SparseMatrix<double>(0, 0));
  EXPECT_EQ(solver.solve(RowSolver::Rows(0, RowSolver::kWidth)).rows(), 0);
}

TEST(RowSolver, RefusesASystemThatIsNotPositiveDefinite) {
  Eigen::SparseMatrix<double> system(2, 2);
  system.insert(0, 0) = 1;
  system.insert(1, 1) = -1;
  EXPECT_THAT([&] { RowSolver{system}; },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("do not determine")));
}

}  // namespace
}  // namespace mimetra
