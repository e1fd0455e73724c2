// A mesh that is only numbered differently is told from another one, and can be numbered alike.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/operations/call.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// A grid, numbered as it is or backwards.
FieldSequence numbered(bool backwards) {
  test::Shape shape = test::grid(4, 3);
  if (backwards) {
    shape.positions = Positions(shape.positions.colwise().reverse());
    shape.triangles = (11 - shape.triangles.array()).matrix();
  }
  const TriMesh mesh = test::mesh_of(shape);
  return FieldSequence(MeshSequence(
      mesh.connectivity, Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), 36)));
}

class NumberingTest : public testing::Test {
 protected:
  NumberingTest() { add_toolkit(table_); }

  Outcome run(const std::string& name, const FieldSequence& sequence,
              const FieldSequence& reference) {
    const Operation& operation = *table_.find(name);
    Invocation invocation;
    invocation.inputs["sequence"] = {{"export.obj", sequence, {}}};
    invocation.inputs["match"] = {{"neutral.obj", reference, {}}};
    invocation.parameters = Parameters(operation.parameters);
    invocation.log = [this](LogLevel, const std::string& text) { said_.push_back(text); };
    return operation.run(invocation);
  }

  OperationTable table_;
  std::vector<std::string> said_;
};

TEST_F(NumberingTest, IsCheckedAgainstAReference) {
  run("check", numbered(true), numbered(false));
  EXPECT_THAT(said_, ElementsAre(HasSubstr("export.obj: the same faces, 12 vertices renumbered "
                                           "against neutral.obj")));
  said_.clear();
  run("check", numbered(false), numbered(false));
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(NumberingTest, BecomesTheReferences) {
  FieldSequence backwards = numbered(true);
  backwards.fields.push_back(
      {"roi", Field::Location::vertices, Eigen::VectorXd::LinSpaced(12, 0, 11)});
  backwards.fields.push_back({"in_L", Field::Location::triangles, Eigen::VectorXd::Zero(12)});
  const FieldSequence reference = numbered(false);
  const Outcome outcome = run("convert", backwards, reference);
  const auto& made = std::get<FieldSequence>(outcome.outputs.at("out").front().data);
  EXPECT_EQ(made.frames->read(0, 1), reference.frames->read(0, 1));
  EXPECT_TRUE(same_faces(made.frames->connectivity(), reference.frames->connectivity()));
  ASSERT_EQ(made.fields.size(), 1u);
  EXPECT_EQ(made.fields.front().values(0, 0), 11);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("the field in_L of its triangles is left out")));
  EXPECT_THAT(outcome.summary, HasSubstr("the same faces, 12 vertices renumbered"));
}

TEST_F(NumberingTest, SaysWhatOnlyItsOwnFacesHave) {
  const auto with_texture = [](const FieldSequence& plain) {
    Connectivity faces = plain.frames->connectivity();
    faces.texture.coordinates = {{0, 0}, {1, 0}};
    faces.texture.corners.assign(faces.polygons.corners.size(), 1);
    faces.groups = {{0, "g lips"}, {2, "usemtl skin"}};
    return FieldSequence(MeshSequence(std::move(faces), plain.frames->read(0, 1)));
  };
  run("convert", with_texture(numbered(true)), numbered(false));
  EXPECT_THAT(said_, ElementsAre("export.obj: its texture coordinates, groups and materials are "
                                 "left out: the faces are those of neutral.obj, which has none"));
  said_.clear();
  run("convert", with_texture(numbered(true)), with_texture(numbered(false)));
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(NumberingTest, ChoosesNoFramesOfTheReference) {
  const test::TemporaryFolder folder;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* file : {"take/0.obj", "take/1.obj", "neutral.obj"}) {
    std::filesystem::create_directories(folder / "take");
    std::ofstream(folder / file) << text;
  }
  CallRequest request;
  request.operation = table_.find("check");
  request.parameters = Parameters(table_.parameters_of(*request.operation));
  request.parameters.set("frames", "1:2");
  request.named = {{"sequence", {(folder / "take").string()}},
                   {"match", {(folder / "neutral.obj").string()}}};
  Call call(table_, std::move(request));
  call.load();
  EXPECT_EQ(call.invocation().get<FieldSequence>("sequence").frames->frames(), 1);
  EXPECT_EQ(call.invocation().get<FieldSequence>("match").frames->frames(), 1);
}

TEST_F(NumberingTest, IsRefusedForAnotherMesh) {
  const TriMesh other = test::mesh_of(test::grid(3, 3));
  const FieldSequence small(MeshSequence(
      other.connectivity, Eigen::Map<const Eigen::RowVectorXd>(other.positions.data(), 27)));
  for (const char* operation : {"check", "convert"}) {
    EXPECT_THAT([&] { run(operation, small, numbered(false)); },
                ThrowsMessage<MismatchError>(
                    "export.obj: another mesh: 9 vertices and 8 faces, expected 12 vertices and "
                    "12 faces (as in neutral.obj)"));
  }
}

}  // namespace
}  // namespace mimetra
