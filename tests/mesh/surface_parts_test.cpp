#include "toolkit/mesh/surface_parts.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::ElementsAre;

/// A small square, then a large one, then a vertex without triangle.
test::Shape squares() {
  test::Shape small = test::grid(2, 2), large = test::grid(2, 2);
  large.positions *= 3;
  large.positions.col(2).setConstant(5);
  test::Shape shape = both(small, large);
  shape.positions.conservativeResize(9, 3);
  shape.positions.row(8) << 7, 7, 7;
  return shape;
}

TEST(SurfaceParts, AreNumberedFromTheLargestSurface) {
  const test::Shape shape = squares();
  const SurfaceParts parts = surface_parts(shape.positions, shape.triangles);
  EXPECT_THAT(parts.of_vertex, ElementsAre(1, 1, 1, 1, 0, 0, 0, 0, 2));
  EXPECT_THAT(parts.areas, ElementsAre(9, 1, 0));
  EXPECT_DOUBLE_EQ(parts.share(0), 0.9);
}

TEST(SurfaceParts, AreNotCutByASeam) {
  const test::Shape left = test::grid(2, 2);
  test::Shape right = test::grid(2, 2);
  right.positions.col(0).array() += 1;
  const test::Shape shape = both(left, right);
  EXPECT_EQ(surface_parts(shape.positions, shape.triangles).count(), 1);
  EXPECT_EQ(surface_parts(shape.positions, shape.triangles, Weld::none(8)).count(), 2);
}

TEST(SubjectBox, IsThatOfThePartsWithTheVertices) {
  const test::Shape shape = squares();
  const SurfaceParts parts = surface_parts(shape.positions, shape.triangles);
  const SubjectBox small = subject_box(shape.positions, parts, {0, 3});
  EXPECT_DOUBLE_EQ(small.diagonal, std::sqrt(2));
  EXPECT_EQ(small.center, Eigen::RowVector3d(0.5, 0.5, 0));
  EXPECT_FALSE(small.is_section);
  EXPECT_DOUBLE_EQ(subject_box(shape.positions, parts, {1, 4, 7}).diagonal,
                   std::sqrt(3 * 3 + 3 * 3 + 5 * 5));
}

TEST(SubjectBox, GrowsThatOfVerticesInASmallSectionOfAPart) {
  const test::Shape strip = test::grid(13, 2);
  const SurfaceParts parts = surface_parts(strip.positions, strip.triangles);
  // From x = 2 to 5 of 12, and from 2 to 7.
  const SubjectBox box = subject_box(strip.positions, parts, {2, 5});
  EXPECT_TRUE(box.is_section);
  EXPECT_DOUBLE_EQ(box.diagonal, 1.5 * 3);
  EXPECT_EQ(box.center, Eigen::RowVector3d(3.5, 0, 0));
  EXPECT_FALSE(subject_box(strip.positions, parts, {2, 7}).is_section);
}

TEST(VertexAreas, AddUpToTheSurface) {
  const test::Shape shape = test::grid(5, 4);
  EXPECT_NEAR(vertex_areas(shape.positions, shape.triangles).sum(), 12, 1e-12);
}

}  // namespace
}  // namespace mimetra
