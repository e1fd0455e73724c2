#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "geodesic/sparse_factor.h"

namespace mimetra::geodesic {
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

template <int Width>
void expect_dense_solution(const SparseFactor::Matrix& system) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Width, Eigen::RowMajor>;
  const auto size = static_cast<int>(system.rows());
  const SparseFactor factor{SparseFactor::Factorization(system)};
  const Rows right = Rows::Random(size, Width);
  const Rows expected = Eigen::MatrixXd(system).ldlt().solve(right);
  Rows ordered(size, Width);
  for (int i = 0; i < size; ++i) ordered.row(factor.order()[i]) = right.row(i);
  const Rows found = factor.solve<Width>(ordered);
  for (int i = 0; i < size; ++i) {
    EXPECT_LT((found.row(factor.order()[i]) - expected.row(i)).norm(), 1e-13) << size;
  }
}

TEST(SparseFactor, AgreesWithADenseSolve) {
  for (const int size : {1, 2, 7, 60}) {
    const SparseFactor::Matrix system = random_system(size, 4);
    expect_dense_solution<8>(system);
    expect_dense_solution<48>(system);
  }
}

TEST(SparseFactor, SolvesNothing) {
  const SparseFactor factor;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 8, Eigen::RowMajor>;
  EXPECT_EQ(factor.solve<8>(Rows(0, 8)).rows(), 0);
}

TEST(SparseFactor, HasAPivotOfEachSign) {
  SparseFactor::Matrix system(2, 2);
  system.insert(0, 0) = 1;
  system.insert(1, 1) = -4;
  const SparseFactor factor{SparseFactor::Factorization(system)};
  EXPECT_EQ(factor.pivots()[factor.order()[0]], 1);
  EXPECT_EQ(factor.pivots()[factor.order()[1]], -4);
}

TEST(SparseFactor, RefusesASystemWithoutOne) {
  SparseFactor::Matrix system(1, 1);
  system.insert(0, 0) = 0;
  EXPECT_THAT([&] { SparseFactor{SparseFactor::Factorization(system)}; },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("singular")));
}

}  // namespace
}  // namespace mimetra::geodesic
