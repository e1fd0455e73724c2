#include "toolkit/correspondence/closest_surface.h"

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/correspondence/closest_in_triangle.h"
#include "tests/shapes.h"
#include "toolkit/mesh/normals.h"

namespace mimetra {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(std::mt19937& generator) {
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  return {coordinate(generator), coordinate(generator), coordinate(generator)};
}

/// The lowest of the nearest triangles that face `normal`, by looking at each.
template <typename Distance>
std::pair<double, int> nearest_of_all(const test::Shape& shape, const Vector3d& normal,
                                      Distance distance) {
  const Positions normals = triangle_normals(shape.positions, shape.triangles);
  std::pair<double, int> best{std::numeric_limits<double>::infinity(), -1};
  for (int t = 0; t < shape.triangles.rows(); ++t) {
    if (normals.row(t).dot(normal) <= 0) continue;
    best = std::min(best, {distance(shape.positions.row(shape.triangles(t, 0)),
                                    shape.positions.row(shape.triangles(t, 1)),
                                    shape.positions.row(shape.triangles(t, 2))),
                           t});
  }
  return best;
}

TEST(ClosestSurface, MeasuresTheDistanceWhicheverWayItFaces) {
  const test::Shape shape = test::sphere(2);
  const ClosestSurface surface(shape.positions, shape.triangles);
  std::mt19937 generator(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3d point = random_vector(generator);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& corners : shape.triangles.rowwise()) {
      const Vector3d at =
          test::closest_in(point, shape.positions.row(corners[0]), shape.positions.row(corners[1]),
                           shape.positions.row(corners[2]));
      nearest = std::min(nearest, (at - point).norm());
    }
    EXPECT_NEAR(surface.distance(point), nearest, 1e-14);
  }
}

TEST(ClosestSurface, SeesTheSideThatARayMeets) {
  const test::Shape shape = test::sphere(2);
  const ClosestSurface surface(shape.positions, shape.triangles);
  EXPECT_EQ(surface.seen_from({0.1, 0.2, 0}, {1, 2, 3}), Seen::back);
  EXPECT_EQ(surface.seen_from({3, 0.1, 0.2}, {-1, 0, 0}), Seen::front);
  EXPECT_EQ(surface.seen_from({3, 0.1, 0.2}, {1, 0, 0}), Seen::nothing);
}

TEST(ClosestSurface, FindsWhatLookingAtEachTriangleFinds) {
  const test::Shape shape = test::sphere(2);
  const ClosestSurface surface(shape.positions, shape.triangles);
  std::mt19937 generator(3);
  for (int i = 0; i < 300; ++i) {
    const Vector3d point = random_vector(generator), normal = random_vector(generator);
    const auto [distance, t] =
        nearest_of_all(shape, normal, [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
          return (test::closest_in(point, a, b, c) - point).norm();
        });
    const SurfacePoint found = surface.closest(point, normal);
    // Rounding only: both are of the size of the sphere.
    EXPECT_NEAR(std::sqrt(found.squared_distance), distance, 1e-14);
    EXPECT_NEAR((found.position - point).norm(), distance, 1e-14);
    EXPECT_FALSE(found.on_border);
    const auto [to_middle, nearest] =
        nearest_of_all(shape, normal, [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
          return ((a + b + c) / 3 - point).norm();
        });
    EXPECT_NEAR(std::sqrt(surface.nearest_centroid(point, normal).squared_distance), to_middle,
                1e-14);
  }
}

TEST(ClosestSurface, PassesOverASheetThatFacesTheOtherWay) {
  test::Shape upper = test::grid(3, 3), lower = test::grid(3, 3);
  lower.triangles.col(1).swap(lower.triangles.col(2));
  upper.positions.col(2).setConstant(1);
  const test::Shape lips = test::both(upper, lower);
  const ClosestSurface surface(lips.positions, lips.triangles);
  // Nearer to the lower sheet, and facing as the upper one.
  EXPECT_EQ(surface.closest({1.1, 1.2, 0.1}, {0, 0, 1}).position.z(), 1);
  EXPECT_EQ(surface.closest({1.1, 1.2, 0.9}, {0, 0, -1}).position.z(), 0);
}

TEST(ClosestSurface, FindsNothingWhereNothingFacesThatWay) {
  const test::Shape flat = test::grid(3, 3);
  EXPECT_EQ(ClosestSurface(flat.positions, flat.triangles).closest({1, 1, 1}, {0, 0, -1}).triangle,
            -1);
}

TEST(ClosestSurface, TellsItsBorder) {
  const test::Shape flat = test::grid(4, 4);
  const ClosestSurface surface(flat.positions, flat.triangles);
  EXPECT_TRUE(surface.closest({-1, 1.5, 0.3}, {0, 0, 1}).on_border);
  EXPECT_TRUE(surface.closest({-1, -1, 0.3}, {0, 0, 1}).on_border);
  EXPECT_FALSE(surface.closest({0.2, 1.5, 0.3}, {0, 0, 1}).on_border);
  EXPECT_FALSE(surface.closest({1, 1, 0.3}, {0, 0, 1}).on_border) << "a vertex inside";
}

TEST(ClosestSurface, KnowsTheSidesOfAMouthByTheirDirection) {
  // Two strips with a slit between them: the border of the upper one runs against the lower one's.
  test::Shape lower = test::grid(5, 2), upper = test::grid(5, 2);
  upper.positions.col(1).array() += 1.1;
  const test::Shape mouth = test::both(lower, upper);
  const ClosestSurface surface(mouth.positions, mouth.triangles);
  const Vector3d in_the_slit(2.2, 1.01, 0), front(0, 0, 1);
  EXPECT_EQ(surface.closest_on_border(in_the_slit, front, {-1, 0, 0}).position.y(), 1);
  EXPECT_EQ(surface.closest_on_border(in_the_slit, front, {1, 0, 0}).position.y(), 1.1);
}

}  // namespace
}  // namespace mimetra
