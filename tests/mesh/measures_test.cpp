#include "toolkit/mesh/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"

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

TEST(Extent, IsTheLongestSideOfTheBoxAndZeroOfNothing) {
  Positions positions(2, 3);
  positions << 1, 1, 1, 3, 4, 7;
  EXPECT_EQ(extent(positions), 6);
  EXPECT_EQ(box_diagonal(positions), 7);
  EXPECT_EQ(extent(Positions(0, 3)), 0);
  EXPECT_EQ(box_diagonal(Positions(0, 3)), 0);
}

TEST(TriangleQuality, OfTheEquilateralTriangleIsTheLargest) {
  // 2 A / l^2 = sqrt(3) / 2, up to a few roundings.
  EXPECT_NEAR(triangle_quality({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), std::sqrt(3) / 2, 1e-15);
}

TEST(TriangleQuality, WithoutAreaIsZeroAndAtAnyScaleTheSame) {
  EXPECT_EQ(triangle_quality({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
  EXPECT_EQ(triangle_quality({1, 2, 3}, {1, 2, 3}, {1, 2, 3}), 0);
  const Eigen::Vector3d a(0, 0, 0), b(3, 0, 0), c(1, 2, 0);
  // Powers of two scale without rounding.
  EXPECT_EQ(triangle_quality(a, b, c), triangle_quality(a, b / 1024, c / 1024));
}

TEST(VertexAreas, AddUpToTheSurface) {
  const test::Shape shape = test::grid(5, 4);
  EXPECT_NEAR(vertex_areas(shape.positions, shape.triangles).sum(), 12, 1e-12);
}

}  // namespace
}  // namespace mimetra
