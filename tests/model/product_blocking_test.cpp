#include <random>

#include "tests/cache_sizes.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/smooth_weights.h"

namespace mimetra {
namespace {

class ProductBlocking : public testing::Test {
 protected:
  Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return normal_(random_); });
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

TEST_F(ProductBlocking, IsFixedForAnimations) {
  constexpr int kVertices = 40, kExpressions = 1200, kFrames = 30;
  ShapeBasis expressions{{}, random_matrix(3 * kVertices, kExpressions)};
  for (int j = 0; j < kExpressions; ++j) expressions.names.push_back(std::to_string(j));
  const Triangles triangle = Eigen::RowVector3i(0, 1, 2);
  const BlendshapeModel model(
      std::make_shared<Connectivity>(Connectivity::from_triangles(kVertices, triangle)),
      random_matrix(kVertices, 3), std::move(expressions));
  const Eigen::MatrixXd weights = random_matrix(kFrames, kExpressions);
  test::expect_equal_bytes_on_each_processor(
      [&] { return Eigen::MatrixXd(model.animate(weights).positions()); });
}

TEST_F(ProductBlocking, IsFixedForSmoothWeights) {
  constexpr int kExpressions = 90, kFrames = 8;
  const Eigen::MatrixXd columns = random_matrix(2 * kExpressions, kExpressions);
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const Eigen::MatrixXd h = 50 * random_matrix(kFrames, kExpressions);
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(kFrames, 0, 1);
  test::expect_equal_bytes_on_each_processor(
      [&] { return smooth_weights({gram}, h, times, 1, Eigen::MatrixXd(h)); });
}

}  // namespace
}  // namespace mimetra
