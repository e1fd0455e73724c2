// Finders of faces are tested where they are.

#include <cstdint>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/operations/call.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class MarkersTest : public testing::Test {
 protected:
  MarkersTest() {
    add_toolkit(table_);
    add_markers(table_);
    for (const char* name : {"source", "target"}) {
      std::filesystem::create_directory(folder_ / name);
      std::ofstream mesh(folder_ / name / "neutral.obj");
      const test::Shape shape = test::sphere(1);
      for (const auto& row : shape.positions.rowwise()) mesh << "v " << row << '\n';
      for (const auto& row : shape.triangles.rowwise()) mesh << "f " << row.array() + 1 << '\n';
    }
  }

  void landmarks(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name / "landmarks68.txt") << "[landmark_mappings]\n" << text;
  }

  Outcome run() {
    CallRequest request;
    request.operation = table_.find("markers");
    request.parameters = Parameters(table_.parameters_of(*request.operation));
    request.parameters.set("pixels", std::int64_t{64});
    request.named = {{"source", {folder_ / "source" / "neutral.obj"}},
                     {"target", {folder_ / "target" / "neutral.obj"}}};
    request.destinations["out"] = {folder_ / "found.markers"};
    request.log = [this](LogLevel, const std::string& text) { said_.push_back(text); };
    Call call(table_, std::move(request));
    call.load();
    call.run();
    call.write();
    return call.outcome();
  }

  OperationTable table_;
  std::vector<std::string> said_;
  test::TemporaryFolder folder_;
};

TEST_F(MarkersTest, AreThoseOfFilesBesideBothMeshes) {
  landmarks("source", "31 = 4\n37 = 0\n46 = 1\n9 = 2\n");
  landmarks("target", "9 = 12\n31 = 5\n37 = 10\n46 = 11\n");
  const Outcome outcome = run();
  EXPECT_EQ(read_markers(folder_ / "found.markers"),
            (std::vector<Marker>{{2, 12}, {4, 5}, {0, 10}, {1, 11}}));
  EXPECT_THAT(read_file(folder_ / "found.markers"), HasSubstr("2 12  # jaw (landmark 9)\n"));
  EXPECT_THAT(outcome.summary, HasSubstr("4 markers"));
  EXPECT_THAT(said_, ElementsAre(HasSubstr("only 4 markers")));
}

TEST_F(MarkersTest, NeedAFinderOtherwise) {
  landmarks("source", "31 = 4\n37 = 0\n46 = 1\n9 = 2\n");
  EXPECT_THAT(test::message_of<MismatchError>([this] { run(); }),
              HasSubstr("neutral.obj: this program cannot find faces"));
}

TEST_F(MarkersTest, AreLookedForByTheProgramsFinder) {
  table_.add([](const GreyImage&) { return std::optional<FoundFace>(); });
  EXPECT_THAT(test::message_of<MismatchError>([this] { run(); }),
              HasSubstr("neutral.obj: no face was found"));
  EXPECT_THROW(table_.add([](const GreyImage&) { return std::optional<FoundFace>(); }),
               std::invalid_argument);
}

TEST_F(MarkersTest, DoNotComeFromAFileOfAnotherMesh) {
  landmarks("source", "31 = 18\n");
  const NamedData value{folder_ / "source" / "neutral.obj",
                        FieldSequence(MeshSequence(test::mesh_of(test::sphere(1)).connectivity,
                                                   Eigen::Map<const Eigen::RowVectorXd>(
                                                       test::sphere(1).positions.data(), 54)))};
  const Log log = [this](LogLevel, const std::string& text) { said_.push_back(text); };
  EXPECT_THAT(head_of(value, log).known, IsEmpty());
  EXPECT_THAT(said_, ElementsAre(HasSubstr("landmarks68.txt: names vertex 18")));
  landmarks("source", "31 = 17\n");
  EXPECT_THAT(head_of(value, log).known, ElementsAre(Pair(30, 17)));
  EXPECT_THAT(head_of(value, log, true).known, IsEmpty());
}

}  // namespace
}  // namespace mimetra
