#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/model/retargeting.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

/// Three expressions from two.
Retargeting small_map() {
  Retargeting map;
  map.source_names = {"a", "b"};
  map.target_names = {"x", "y", "z"};
  map.gram = Eigen::Matrix3d{{4, 1, 0}, {1, 3, 1}, {0, 1, 2}};
  map.linear = Eigen::Matrix<double, 3, 2>{{1, 0}, {2, 1}, {0, 3}};
  map.lower = Eigen::Vector3d::Zero();
  map.upper = Eigen::Vector3d::Ones();
  return map;
}

std::string refusal_of_map(const Retargeting& map) {
  return test::message_of<std::invalid_argument>([&] { map.check(); });
}

TEST(PlainMatrix, SolvesWithoutBounds) {
  const Retargeting map = small_map();
  map.check();
  EXPECT_LE((map.gram * plain_matrix(map) - map.linear).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(PlainMatrix, IsTheLeastWhereThereAreMany) {
  Retargeting map = small_map();
  // x and y move alike: only their sum counts, which both share.
  map.gram = Eigen::Matrix3d{{1, 1, 0}, {1, 1, 0}, {0, 0, 2}};
  map.linear = Eigen::Matrix<double, 3, 2>{{1, 0}, {1, 0}, {0, 2}};
  const Eigen::MatrixXd expected = Eigen::Matrix<double, 3, 2>{{0.5, 0}, {0.5, 0}, {0, 1}};
  EXPECT_LE((plain_matrix(map) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(PlainMatrix, LeavesOutWhatCannotMove) {
  Retargeting map = small_map();
  map.upper[1] = 0;
  const Eigen::MatrixXd matrix = plain_matrix(map);
  EXPECT_TRUE(matrix.row(1).isZero(0));
  const Eigen::MatrixXd left = map.gram * matrix - map.linear;
  EXPECT_LE(left.row(0).norm() + left.row(2).norm(), 1e-14);
}

TEST(PlainMatrix, IsAppliedToEveryFrame) {
  const Eigen::MatrixXd matrix = Eigen::Matrix<double, 3, 2>{{1, 2}, {3, 4}, {5, 6}};
  const Eigen::MatrixXd weights = Eigen::Matrix2d{{1, 0}, {0.5, -1}};
  const Eigen::MatrixXd expected = Eigen::Matrix<double, 2, 3>{{1, 3, 5}, {-1.5, -2.5, -3.5}};
  EXPECT_TRUE(multiplied(matrix, weights) == expected);
  EXPECT_THROW(multiplied(matrix, Eigen::MatrixXd::Zero(2, 3)), std::invalid_argument);
}

TEST(ClippedWeights, StayWithinTheBounds) {
  Retargeting map = small_map();
  map.upper[2] = 0.5;
  const Eigen::MatrixXd weights = Eigen::Matrix<double, 1, 3>{-1, 0.25, 2};
  EXPECT_EQ(clipped(weights, map), (Eigen::MatrixXd(Eigen::Matrix<double, 1, 3>{0, 0.25, 0.5})));
  EXPECT_THROW(clipped(Eigen::MatrixXd::Zero(1, 2), map), std::invalid_argument);
}

TEST(WeightDifferences, AreRootMeanSquareMeanAndLargest) {
  const Eigen::MatrixXd weights = Eigen::Matrix<double, 1, 4>{0, 0, 0, 0};
  const Eigen::MatrixXd others = Eigen::Matrix<double, 1, 4>{1, -1, 3, -3};
  const WeightDifference found = difference_of(weights, others);
  EXPECT_DOUBLE_EQ(found.rms, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(found.mean, 2);
  EXPECT_DOUBLE_EQ(found.largest, 3);
  EXPECT_EQ(difference_of(Eigen::MatrixXd(0, 4), Eigen::MatrixXd(0, 4)).largest, 0);
  EXPECT_THROW(difference_of(weights, Eigen::MatrixXd::Zero(2, 2)), std::invalid_argument);
}

TEST(RetargetingCheck, NamesWhatIsWrong) {
  Retargeting map = small_map();
  map.target_names[2] = "x";
  EXPECT_THAT(refusal_of_map(map), HasSubstr("the target has the expression 'x' twice"));
  map = small_map();
  map.source_names.clear();
  EXPECT_THAT(refusal_of_map(map), HasSubstr("the source has no expressions"));
  map = small_map();
  map.linear.resize(3, 3);
  EXPECT_THAT(refusal_of_map(map), HasSubstr("the linear part is 3 x 3, expected 3 x 2"));
  map = small_map();
  map.gram(0, 1) = 2;
  EXPECT_THAT(refusal_of_map(map), HasSubstr("not symmetric"));
  map = small_map();
  map.gram(2, 2) = -1;
  EXPECT_THAT(refusal_of_map(map), HasSubstr("a negative eigenvalue"));
  map = small_map();
  map.lower[1] = 2;
  EXPECT_THAT(refusal_of_map(map), HasSubstr("the bounds of 'y' cross"));
  map = small_map();
  map.linear(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal_of_map(map), HasSubstr("not finite"));
}

}  // namespace
}  // namespace mimetra
