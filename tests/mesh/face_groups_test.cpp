#include "toolkit/mesh/face_groups.h"

#include <gmock/gmock.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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
