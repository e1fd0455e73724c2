#include "toolkit/mesh/diameter.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace mimetra {
namespace {

/// Every pair, one after the other.
double literal_diameter(const Positions& points) {
  double largest = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      largest = std::max(largest, (points.row(i) - points.row(j)).norm());
    }
  }
  return largest;
}

Positions random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Positions::NullaryExpr(count, 3, [&] { return normal(random); });
}

TEST(Diameter, IsTheLargestDistanceOfAllPairs) {
  for (const int count : {2, 3, 16, 17, 40, 300, 1000}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      Positions points = random_points(count, seed);
      EXPECT_DOUBLE_EQ(diameter(points), literal_diameter(points)) << count;
      // On a sphere all points are nearly as far from some other one; on a disc and a line some
      // balls have no thickness.
      const Positions on_sphere = points.rowwise().normalized();
      EXPECT_NEAR(diameter(on_sphere), literal_diameter(on_sphere), 1e-13) << count;
      points.col(2).setZero();
      EXPECT_DOUBLE_EQ(diameter(points), literal_diameter(points)) << count;
      points.col(1).setZero();
      EXPECT_DOUBLE_EQ(diameter(points), literal_diameter(points)) << count;
    }
  }
}

TEST(Diameter, StaysWherePointsAreTurnedMovedOrRenumbered) {
  const Positions points = random_points(500, 3);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Positions moved = (points * turn.transpose()).rowwise() + Eigen::RowVector3d(40, -30, 20);
  EXPECT_NEAR(diameter(moved), diameter(points), 1e-12);
  EXPECT_DOUBLE_EQ(diameter(points.colwise().reverse()), diameter(points));
}

TEST(Diameter, IsZeroWhereNoTwoPointsDiffer) {
  EXPECT_EQ(diameter(Positions(0, 3)), 0);
  EXPECT_EQ(diameter(Positions::Ones(1, 3)), 0);
  EXPECT_EQ(diameter(Positions::Ones(100, 3)), 0);
}

TEST(Diameter, PassesOverPointsThatAreNotFinite) {
  Positions points = random_points(60, 1);
  const double expected = literal_diameter(points.topRows(58));
  points(58, 1) = std::numeric_limits<double>::quiet_NaN();
  points(59, 2) = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(diameter(points), expected);
}

TEST(Diameter, OfAMeshIsThatOfTheVerticesItsTrianglesUse) {
  Positions points(4, 3);
  points << 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, 100;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  EXPECT_EQ(diameter(points, triangles), 5);
  EXPECT_EQ(diameter(points, Triangles(0, 3)), diameter(points));
  // One without area has no say, unless there is no other.
  Triangles flat(2, 3);
  flat << 0, 1, 2, 0, 0, 3;
  EXPECT_EQ(diameter(points, flat), 5);
  EXPECT_EQ(diameter(points, flat.bottomRows(1)), 100);
}

}  // namespace
}  // namespace mimetra
