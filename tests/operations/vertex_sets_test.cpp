#include "toolkit/operations/parameter_files.h"

#include <fstream>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A triangle, and a larger one, each with its group and material; the first vertex has a field.
FieldSequence triangles() {
  test::Shape shape{Positions(6, 3), Triangles(2, 3)};
  shape.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 0, 0, 12, 0, 0, 9, 3, 0;
  shape.triangles << 0, 1, 2, 3, 4, 5;
  Connectivity connectivity = Connectivity::from_triangles(6, shape.triangles);
  connectivity.groups = {{0, "g tooth"}, {0, "usemtl bone"}, {1, "g skin"}, {1, "usemtl flesh"}};
  const Frames frames = Positions(shape.positions).reshaped<Eigen::RowMajor>().transpose();
  Field mask{"mask", Field::Location::vertices, Eigen::VectorXd::Unit(6, 0)};
  return {MeshSequence(connectivity, frames), {mask}};
}

std::vector<bool> named(const std::string& text) {
  return named_vertices(text, triangles());
}

TEST(NamedVertices, AreThoseOfAComponentGroupMaterialFieldOrFile) {
  // The largest component first.
  EXPECT_THAT(named("component:0"), ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(named("component:1"), ElementsAre(1, 1, 1, 0, 0, 0));
  EXPECT_THAT(named("component:0,1"), ElementsAre(1, 1, 1, 1, 1, 1));
  EXPECT_THAT(named("group:tooth"), ElementsAre(1, 1, 1, 0, 0, 0));
  EXPECT_THAT(named("material:flesh"), ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(named("field:mask"), ElementsAre(1, 0, 0, 0, 0, 0));
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "list.txt").string();
  std::ofstream(path) << "1\n4\n5\n";
  EXPECT_THAT(named(path), ElementsAre(0, 1, 0, 0, 1, 1));
}

TEST(NamedVertices, AreRefusedUnderAnUnknownNameWithThoseThatExist) {
  EXPECT_THAT([] { named("group:lips"); },
              ThrowsMessage<MismatchError>("group 'lips' is not there; there are tooth, skin"));
  EXPECT_THAT([] { named("component:7"); },
              ThrowsMessage<MismatchError>(HasSubstr("there are 0, 1")));
  EXPECT_THAT([] { named("field:nose"); }, ThrowsMessage<MismatchError>(HasSubstr("mask")));
}

TEST(VertexSetParameter, IsNoFileWhereItNamesPartsOfTheMesh) {
  Parameters parameters({vertex_set_parameter("only", "")});
  parameters.set("only", "group:tooth,skin");
  EXPECT_THAT(parameters.files(), testing::IsEmpty());
  parameters.set("only", "group.txt");
  EXPECT_THAT(parameters.files(), ElementsAre("group.txt"));
}

}  // namespace
}  // namespace mimetra
