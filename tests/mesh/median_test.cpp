#include "toolkit/mesh/median.h"

#include <gtest/gtest.h>

namespace mimetra {
namespace {

TEST(Median, IsInTheMiddleInAnyOrderOrTheUpperOfTwo) {
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({-1, 9, 9, -1, 4}), 4);
  EXPECT_EQ(median({4, 2}), 4);
  EXPECT_EQ(median({1, 8, 2, 6}), 6);
}

TEST(Median, OfDifferencesIsTheUsualStep) {
  EXPECT_EQ(median_difference(Eigen::Vector2d(3, 5)), 2);
  // Two regular steps, and a gap of ten.
  EXPECT_EQ(median_difference(Eigen::Vector4d(0, 1, 11, 12)), 1);
}

}  // namespace
}  // namespace mimetra
