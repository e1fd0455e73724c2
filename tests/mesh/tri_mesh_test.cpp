#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
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

TEST(Connectivity, KeepsThePolygonsAndKnowsThatOfEachTriangle) {
  const Polygons polygons{{0, 1, 2, 3, 3, 2, 4}, {0, 4, 7}};
  EXPECT_EQ(quad_and_triangle().polygons, polygons);
  EXPECT_THAT(quad_and_triangle().polygon_of_triangle, ElementsAre(0, 0, 1));
}

TEST(Connectivity, OfTrianglesHasThemAsPolygons) {
  const auto shape = test::octahedron();
  const Connectivity connectivity = Connectivity::from_triangles(6, shape.triangles);
  EXPECT_EQ(connectivity.triangles, shape.triangles);
  EXPECT_EQ(connectivity.polygons.size(), 8);
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

TEST(SameFaces, FailsForAFlippedPolygonAndForMoreVertices) {
  const Connectivity flipped = Connectivity::from_polygons(5, {{0, 1, 2, 3, 4, 2, 3}, {0, 4, 7}});
  EXPECT_FALSE(same_faces(quad_and_triangle(), flipped));
  EXPECT_EQ(first_different_face(quad_and_triangle(), flipped), 1);
  Connectivity larger = quad_and_triangle();
  larger.vertices = 6;
  EXPECT_FALSE(same_faces(quad_and_triangle(), larger));
}

TEST(SameFaces, FailsForASplitPolygon) {
  const Connectivity split =
      Connectivity::from_polygons(5, {{0, 1, 2, 0, 2, 3, 3, 2, 4}, {0, 3, 6, 9}});
  EXPECT_EQ(split.triangles, quad_and_triangle().triangles);
  EXPECT_EQ(first_different_face(quad_and_triangle(), split), 0);
}

TEST(FirstDifferentFace, IsTheFirstOneThatOnlyOneMeshHas) {
  const Connectivity shorter = Connectivity::from_polygons(5, {{0, 1, 2, 3}, {0, 4}});
  EXPECT_EQ(first_different_face(quad_and_triangle(), shorter), 1);
  EXPECT_EQ(first_different_face(quad_and_triangle(), quad_and_triangle()), -1);
}

TEST(Connectivity, KnowsTheVerticesThatTrianglesUse) {
  Triangles triangles(1, 3);
  triangles << 4, 1, 2;
  EXPECT_THAT(used_vertices(triangles, 6), ElementsAre(1, 2, 4));
  EXPECT_THAT(used_vertices(Triangles(0, 3), 3), ElementsAre(0, 1, 2));
}

/// Four triangles with the statements of an OBJ file.
Connectivity grouped() {
  const test::Shape shape = test::grid(3, 2);
  Connectivity connectivity = Connectivity::from_triangles(6, shape.triangles);
  connectivity.groups = {{0, "g skin lips"}, {0, "usemtl wet skin"}, {1, "s 1"}, {2, "o teeth"},
                         {3, "g"},           {4, "g nothing"}};
  return connectivity;
}

TEST(NamedFaces, AreInEachGroupThatStatementsName) {
  const std::vector<NamedFaces> groups = named_faces(grouped(), FaceGroupKind::group);
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].name, "skin");
  EXPECT_THAT(groups[0].faces, ElementsAre(0, 1, 2));
  EXPECT_EQ(groups[1].name, "lips");
  EXPECT_THAT(groups[1].faces, ElementsAre(0, 1, 2));
  EXPECT_EQ(groups[2].name, "teeth");
  EXPECT_THAT(groups[2].faces, ElementsAre(2, 3));
}

TEST(NamedFaces, KeepTheSpacesOfAMaterial) {
  const std::vector<NamedFaces> materials = named_faces(grouped(), FaceGroupKind::material);
  ASSERT_EQ(materials.size(), 1U);
  EXPECT_EQ(materials[0].name, "wet skin");
  EXPECT_THAT(materials[0].faces, ElementsAre(0, 1, 2, 3));
}

TEST(NamedFaces, AreNoneWithoutStatements) {
  const test::Shape shape = test::grid(3, 2);
  const Connectivity bare = Connectivity::from_triangles(6, shape.triangles);
  EXPECT_THAT(named_faces(bare, FaceGroupKind::group), IsEmpty());
}

}  // namespace
}  // namespace mimetra
