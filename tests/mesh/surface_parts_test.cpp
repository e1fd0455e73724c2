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

/// A sheet of unit squares that is `width` x `height` vertices large.
class Rims : public testing::Test {
 protected:
  static constexpr int kWidth = 21, kHeight = 17;

  /// Without the triangles that have a vertex in the box around a place.
  static test::Shape sheet_with_hole(double x, double y, double half_width, double half_height) {
    test::Shape sheet = test::grid(kWidth, kHeight);
    std::vector<int> kept;
    for (int t = 0; t < sheet.triangles.rows(); ++t) {
      bool is_in_hole = false;
      for (const VertexIndex v : sheet.triangles.row(t)) {
        is_in_hole |= std::abs(sheet.positions(v, 0) - x) < half_width &&
                      std::abs(sheet.positions(v, 1) - y) < half_height;
      }
      if (!is_in_hole) kept.push_back(t);
    }
    const Triangles triangles = sheet.triangles(kept, Eigen::all);
    sheet.triangles = triangles;
    return sheet;
  }

  static std::vector<bool> near(const test::Shape& shape) {
    return near_rims(shape.positions, shape.triangles, Weld::exact(shape.positions));
  }

  static bool is_at_edge(const Eigen::RowVector3d& place, double distance) {
    return place[0] <= distance || place[0] >= kWidth - 1 - distance || place[1] <= distance ||
           place[1] >= kHeight - 1 - distance;
  }
};

TEST_F(Rims, AreTheEdgeOfASheetAndTheTrianglesThere) {
  const test::Shape sheet = test::grid(kWidth, kHeight);
  const std::vector<bool> near = this->near(sheet);
  for (VertexIndex v = 0; v < sheet.positions.rows(); ++v) {
    EXPECT_EQ(near[v], is_at_edge(sheet.positions.row(v), 1)) << v;
  }
}

TEST_F(Rims, AreNotTheOpeningsOfAFace) {
  // As a mouth: a quarter of the sheet wide.
  const test::Shape sheet = sheet_with_hole(10, 5, 3, 1.5);
  const std::vector<bool> near = this->near(sheet);
  for (VertexIndex v = 0; v < sheet.positions.rows(); ++v) {
    EXPECT_EQ(near[v], is_at_edge(sheet.positions.row(v), 1)) << v;
  }
}

TEST_F(Rims, AreNotTheOpeningsOfAClosedSurface) {
  test::Shape ball = test::sphere(3);
  const Triangles kept = ball.triangles.bottomRows(ball.triangles.rows() - 1);
  ball.triangles = kept;
  const std::vector<bool> near = this->near(ball);
  EXPECT_EQ(std::ranges::count(near, true), 0);
}

TEST_F(Rims, AreNotWhereSeamsAreWelded) {
  // Every triangle with corners of its own.
  const test::Shape sheet = test::grid(kWidth, kHeight);
  test::Shape apart;
  apart.positions.resize(sheet.triangles.size(), 3);
  apart.triangles.resize(sheet.triangles.rows(), 3);
  for (int t = 0; t < sheet.triangles.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      apart.positions.row(3 * t + c) = sheet.positions.row(sheet.triangles(t, c));
      apart.triangles(t, c) = 3 * t + c;
    }
  }
  const std::vector<bool> near = this->near(apart);
  for (VertexIndex v = 0; v < apart.positions.rows(); ++v) {
    EXPECT_EQ(near[v], is_at_edge(apart.positions.row(v), 1)) << v;
  }
}

}  // namespace
}  // namespace mimetra
