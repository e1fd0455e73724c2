#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Connectivity quad_and_triangle() {
  return Connectivity::from_polygons(5, {{0, 1, 2, 3, 3, 2, 4}, {0, 4, 7}});
}

TEST(Connectivity, CutsAPolygonIntoAFanAboutItsFirstCorner) {
  const Connectivity pentagon = Connectivity::from_polygons(5, {{4, 0, 1, 2, 3}, {0, 5}});
  Triangles fan(3, 3);
  fan << 4, 0, 1, 4, 1, 2, 4, 2, 3;
  EXPECT_EQ(pentagon.triangles, fan);
}

TEST(Connectivity, KnowsThePolygonOfEachTriangle) {
  EXPECT_THAT(quad_and_triangle().polygon_of_triangle, ElementsAre(0, 0, 1));
}

TEST(Connectivity, KeepsThePolygonsAsGiven) {
  const Polygons polygons{{0, 1, 2, 3, 3, 2, 4}, {0, 4, 7}};
  EXPECT_EQ(quad_and_triangle().polygons, polygons);
}

TEST(Connectivity, OfTrianglesHasThemAsPolygons) {
  const auto shape = test::octahedron();
  const Connectivity connectivity = Connectivity::from_triangles(6, shape.triangles);
  EXPECT_EQ(connectivity.triangles, shape.triangles);
  EXPECT_EQ(connectivity.polygons.size(), 8);
}

TEST(Connectivity, MayHaveVerticesWithoutFaces) {
  EXPECT_EQ(Connectivity::from_triangles(7, Triangles(0, 3)).vertices, 7);
}

TEST(Connectivity, NamesTheFirstPolygonWithTooFewCorners) {
  EXPECT_THAT(
      [] {
        Connectivity::from_polygons(3, {{0, 1, 2, 0, 1}, {0, 3, 5}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 1 has 2 corners, expected at least 3")));
}

TEST(Connectivity, NamesTheFirstPolygonWithABadIndex) {
  EXPECT_THAT(
      [] {
        Connectivity::from_polygons(3, {{0, 1, 2, 0, 1, 3}, {0, 3, 6}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 1 uses vertex 3, expected 0 to 2")));
  EXPECT_THAT(
      [] {
        Connectivity::from_polygons(3, {{-1, 1, 2}, {0, 3}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 0 uses vertex -1")));
}

TEST(Connectivity, RefusesOffsetsThatDoNotCoverTheCorners) {
  EXPECT_THAT(
      [] {
        Connectivity::from_polygons(4, {{0, 1, 2, 3}, {0, 3}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("polygon offsets")));
  EXPECT_THROW(Connectivity::from_polygons(4, {{0, 1, 2, 3, 0, 1}, {0, 7, 6}}),
               std::invalid_argument);
}

TEST(SameFaces, HoldsForRotatedPolygons) {
  const Connectivity rotated = Connectivity::from_polygons(5, {{2, 3, 0, 1, 2, 4, 3}, {0, 4, 7}});
  EXPECT_TRUE(same_faces(quad_and_triangle(), rotated));
}

TEST(SameFaces, FailsForAFlippedPolygon) {
  const Connectivity flipped = Connectivity::from_polygons(5, {{0, 1, 2, 3, 4, 2, 3}, {0, 4, 7}});
  EXPECT_FALSE(same_faces(quad_and_triangle(), flipped));
  EXPECT_EQ(first_different_face(quad_and_triangle(), flipped), 1);
}

TEST(SameFaces, FailsForASplitPolygon) {
  const Connectivity split =
      Connectivity::from_polygons(5, {{0, 1, 2, 0, 2, 3, 3, 2, 4}, {0, 3, 6, 9}});
  EXPECT_EQ(split.triangles, quad_and_triangle().triangles);
  EXPECT_EQ(first_different_face(quad_and_triangle(), split), 0);
}

TEST(SameFaces, FailsForMoreVertices) {
  Connectivity larger = quad_and_triangle();
  larger.vertices = 6;
  EXPECT_FALSE(same_faces(quad_and_triangle(), larger));
}

TEST(FirstDifferentFace, IsTheFirstOneThatOnlyOneMeshHas) {
  const Connectivity shorter = Connectivity::from_polygons(5, {{0, 1, 2, 3}, {0, 4}});
  EXPECT_EQ(first_different_face(quad_and_triangle(), shorter), 1);
  EXPECT_EQ(first_different_face(quad_and_triangle(), quad_and_triangle()), -1);
}

TEST(Extent, IsTheLongestSideOfTheBox) {
  Positions positions(2, 3);
  positions << 1, 1, 1, 3, 4, 7;
  EXPECT_EQ(extent(positions), 6);
  EXPECT_EQ(box_diagonal(positions), 7);
}

TEST(Extent, OfNothingIsZero) {
  EXPECT_EQ(extent(Positions(0, 3)), 0);
  EXPECT_EQ(box_diagonal(Positions(0, 3)), 0);
}

/// A strip of a quad, a triangle and a quad, and the same faces in another order, from other
/// corners, the first two wound the other way.
struct TwoOrders {
  Connectivity reference =
      Connectivity::from_polygons(7, {{0, 1, 3, 2, 2, 3, 4, 3, 5, 6, 4}, {0, 4, 7, 11}});
  Connectivity other =
      Connectivity::from_polygons(7, {{5, 6, 4, 3, 3, 1, 0, 2, 4, 3, 2}, {0, 4, 8, 11}});
};

TEST(Connectivity, TakesTheTrianglesOfTheSameFacesInAnotherOrder) {
  const TwoOrders orders;
  const auto ordered = in_order_of(orders.reference, orders.other);
  ASSERT_TRUE(ordered);
  Triangles expected = orders.reference.triangles;
  for (const int turned : {0, 1, 2}) std::swap(expected(turned, 1), expected(turned, 2));
  EXPECT_EQ(ordered->triangles, expected);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(1, 1, 2, 0, 0));
  EXPECT_EQ(ordered->polygons, orders.other.polygons);
}

TEST(Connectivity, TakesTheTrianglesOfPolygonsThatAreCutOtherwise) {
  const TwoOrders orders;
  // The first quad along its other diagonal, the second against the way it is wound.
  const Connectivity cut = Connectivity::from_polygons(
      7, {{3, 2, 1, 2, 3, 4, 5, 3, 4, 4, 6, 5, 2, 0, 1}, {0, 3, 6, 9, 12, 15}});
  const auto finer = in_order_of(orders.reference, cut);
  ASSERT_TRUE(finer);
  Triangles expected = orders.reference.triangles;
  for (const int turned : {3, 4}) std::swap(expected(turned, 1), expected(turned, 2));
  EXPECT_EQ(finer->triangles, expected);
  // Each triangle in the part that has the most of its corners.
  EXPECT_THAT(finer->polygon_of_triangle, ElementsAre(0, 0, 1, 2, 2));
  EXPECT_EQ(finer->polygons, cut.polygons);

  const auto coarser = in_order_of(cut, orders.reference);
  ASSERT_TRUE(coarser);
  expected = cut.triangles;
  for (const int turned : {2, 3}) std::swap(expected(turned, 1), expected(turned, 2));
  EXPECT_EQ(coarser->triangles, expected);
  EXPECT_THAT(coarser->polygon_of_triangle, ElementsAre(0, 1, 2, 2, 0));
}

TEST(Connectivity, TakesTheTrianglesOfAFaceThatHasACornerTwice) {
  const Connectivity one = Connectivity::from_polygons(4, {{0, 1, 2, 3, 3, 1}, {0, 3, 6}});
  const Connectivity other = Connectivity::from_polygons(4, {{1, 3, 3, 1, 2, 0}, {0, 3, 6}});
  const auto ordered = in_order_of(one, other);
  ASSERT_TRUE(ordered);
  EXPECT_EQ(ordered->triangles, one.triangles);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(1, 0));
}

TEST(Connectivity, TakesNoTrianglesOfOtherFaces) {
  const TwoOrders orders;
  // Split along the other diagonal, with a face more, a vertex more, and a face that is there
  // twice.
  EXPECT_FALSE(in_order_of(orders.reference, Connectivity::from_polygons(
                                                 7, {{0, 1, 2, 1, 3, 2, 2, 3, 4}, {0, 3, 6, 9}})));
  Polygons more = orders.other.polygons;
  more.corners.insert(more.corners.end(), {0, 1, 2});
  more.offsets.push_back(14);
  EXPECT_FALSE(in_order_of(orders.reference, Connectivity::from_polygons(7, more)));
  EXPECT_FALSE(
      in_order_of(orders.reference, Connectivity::from_polygons(8, orders.other.polygons)));
  const Polygons twice{{0, 1, 2, 2, 1, 0}, {0, 3, 6}};
  EXPECT_FALSE(
      in_order_of(Connectivity::from_polygons(3, twice), Connectivity::from_polygons(3, twice)));
}

TEST(Connectivity, KnowsTheVerticesThatTrianglesUse) {
  Triangles triangles(1, 3);
  triangles << 4, 1, 2;
  EXPECT_THAT(used_vertices(triangles, 6), ElementsAre(1, 2, 4));
  EXPECT_THAT(used_vertices(Triangles(0, 3), 3), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace mimetra
