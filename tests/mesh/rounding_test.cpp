#include <random>

#include "tests/cache_sizes.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// Long enough to be cut for each of the processors.
constexpr Eigen::Index kLong = 2000;

TEST(ProductBlocking, EigenAloneGivesOtherBytesOnOtherProcessors) {
  const Eigen::MatrixXd a = random_matrix(20, kLong), b = random_matrix(kLong, 30);
  const auto results = test::for_each_processor([&]() -> Eigen::MatrixXd { return a * b; });
  EXPECT_FALSE(test::equal_bytes(results[0], results[1]));
  EXPECT_FALSE(test::equal_bytes(results[1], results[2]));
}

TEST(ProductBlocking, GivesProductsTheSameBytesOnEveryProcessor) {
  const Eigen::MatrixXd a = random_matrix(20, kLong), b = random_matrix(kLong, 30);
  test::expect_equal_bytes_on_each_processor([&]() -> Eigen::MatrixXd {
    fix_product_blocking();
    return a * b;
  });
}

TEST(ProductBlocking, IsFixedForRigidFits) {
  const Positions from = random_matrix(kLong, 3), to = random_matrix(kLong, 3);
  test::expect_equal_bytes_on_each_processor([&] {
    const RigidTransform fit = rigid_fit(from, to);
    return Eigen::MatrixXd(
        (Eigen::Matrix<double, 3, 4>() << fit.rotation, fit.translation).finished());
  });
}

}  // namespace
}  // namespace mimetra
