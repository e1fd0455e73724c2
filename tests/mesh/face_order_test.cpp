#include "toolkit/mesh/face_order.h"

#include <gmock/gmock.h>

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A strip of a quad, a triangle and a quad, and the same faces in another order, from other
/// corners, the first two wound the other way.
struct TwoOrders {
  Connectivity reference =
      Connectivity::from_polygons(7, {{0, 1, 3, 2, 2, 3, 4, 3, 5, 6, 4}, {0, 4, 7, 11}});
  Connectivity other =
      Connectivity::from_polygons(7, {{5, 6, 4, 3, 3, 1, 0, 2, 4, 3, 2}, {0, 4, 8, 11}});
};

TEST(InOrderOf, TakesTheTrianglesOfTheSameFacesInAnotherOrder) {
  const TwoOrders orders;
  const auto ordered = in_order_of(orders.reference, orders.other);
  ASSERT_TRUE(ordered);
  Triangles expected = orders.reference.triangles;
  for (const int turned : {0, 1, 2}) std::swap(expected(turned, 1), expected(turned, 2));
  EXPECT_EQ(ordered->triangles, expected);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(1, 1, 2, 0, 0));
  EXPECT_EQ(ordered->polygons, orders.other.polygons);
}

TEST(InOrderOf, TakesTheTrianglesOfPolygonsThatAreCutOtherwise) {
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

TEST(InOrderOf, TakesTheTrianglesOfAFaceThatHasACornerTwice) {
  const Connectivity one = Connectivity::from_polygons(4, {{0, 1, 2, 3, 3, 1}, {0, 3, 6}});
  const Connectivity other = Connectivity::from_polygons(4, {{1, 3, 3, 1, 2, 0}, {0, 3, 6}});
  const auto ordered = in_order_of(one, other);
  ASSERT_TRUE(ordered);
  EXPECT_EQ(ordered->triangles, one.triangles);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(1, 0));
}

TEST(InOrderOf, TakesNoTrianglesOfOtherFaces) {
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
  // Cut polygons that lie in others, but do not fill them, once.
  const Connectivity quad = Connectivity::from_polygons(4, {{0, 1, 2, 3}, {0, 4}});
  EXPECT_FALSE(in_order_of(quad, Connectivity::from_polygons(4, {{0, 1, 2, 0, 1, 2}, {0, 3, 6}})));
  EXPECT_FALSE(in_order_of(quad, Connectivity::from_polygons(4, {{0, 1, 2, 1, 2, 3}, {0, 3, 6}})));
  EXPECT_FALSE(in_order_of(quad, Connectivity::from_polygons(4, {{0, 1, 2, 0, 3, 2}, {0, 3, 6}})));
  const Polygons twice{{0, 1, 2, 2, 1, 0}, {0, 3, 6}};
  EXPECT_FALSE(
      in_order_of(Connectivity::from_polygons(3, twice), Connectivity::from_polygons(3, twice)));
}

TEST(InOrderOf, TakesAFaceWhoseCornersAreSomeOfAnother) {
  const Connectivity one =
      Connectivity::from_polygons(6, {{0, 1, 2, 3, 1, 3, 2, 4, 5, 3}, {0, 4, 7, 10}});
  const Connectivity other =
      Connectivity::from_polygons(6, {{1, 3, 2, 0, 1, 2, 3, 4, 5, 3}, {0, 3, 7, 10}});
  const auto ordered = in_order_of(one, other);
  ASSERT_TRUE(ordered);
  EXPECT_EQ(ordered->triangles, one.triangles);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(1, 1, 0, 2));
}

TEST(InOrderOf, TakesAPartThatHasNoEdgeOfItsPolygon) {
  const Connectivity hexagon = Connectivity::from_polygons(6, {{0, 1, 2, 3, 4, 5}, {0, 6}});
  const Connectivity cut =
      Connectivity::from_polygons(6, {{0, 2, 4, 0, 1, 2, 2, 3, 4, 4, 5, 0}, {0, 3, 6, 9, 12}});
  const auto ordered = in_order_of(cut, hexagon);
  ASSERT_TRUE(ordered);
  EXPECT_EQ(ordered->triangles, cut.triangles);
  EXPECT_THAT(ordered->polygon_of_triangle, ElementsAre(0, 0, 0, 0));
}

TEST(InOrderOf, TakesTimeThatGrowsWithTheFacesAroundAVertex) {
  constexpr int kBlades = 200000;
  Polygons fan, turned;
  for (int blade = 0; blade < kBlades; ++blade) {
    const int next = (blade + 5) % kBlades;
    fan.corners.insert(fan.corners.end(), {0, 1 + blade, 1 + (blade + 1) % kBlades});
    turned.corners.insert(turned.corners.end(), {0, 1 + next, 1 + (next + 1) % kBlades});
    fan.offsets.push_back(3 * blade + 3);
  }
  turned.offsets = fan.offsets;
  const auto ordered = in_order_of(Connectivity::from_polygons(kBlades + 1, fan),
                                   Connectivity::from_polygons(kBlades + 1, turned));
  ASSERT_TRUE(ordered);
  EXPECT_EQ(ordered->polygon_of_triangle[5], 0);
}

TEST(Outline, IsThePolygonThatFacesMakeTogether) {
  const Polygons faces{{0, 1, 2, 0, 2, 3, 2, 4, 3}, {0, 3, 6, 9}};
  EXPECT_THAT(outline(faces, {0}), ElementsAre(0, 1, 2));
  EXPECT_THAT(outline(faces, {0, 1}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(outline(faces, {0, 1, 2}), ElementsAre(0, 1, 2, 4, 3));
}

TEST(Outline, IsNoneOfFacesThatMakeNoPolygon) {
  // Two apart, two that meet in a corner, two wound against each other, one that is closed.
  EXPECT_THAT(outline({{0, 1, 2, 3, 4, 5}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 2, 3, 4}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 0, 3, 2}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 2, 1, 0}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{}, {0}}, {}), IsEmpty());
}

}  // namespace
}  // namespace mimetra
