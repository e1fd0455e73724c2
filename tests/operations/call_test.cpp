#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/call.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// A bumpy grid that turns as a whole.
MeshSequence turning_grid() {
  const test::Shape shape = test::grid(7, 7);
  Positions rest = shape.positions;
  for (int i = 0; i < rest.rows(); ++i) rest(i, 2) = 0.2 * std::sin(3.0 * i);
  Frames frames(5, rest.size());
  for (int f = 0; f < 5; ++f) {
    RigidTransform turn;
    turn.rotation = Eigen::AngleAxisd(0.1 * f, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const Positions pose = turn.apply(rest);
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return MeshSequence(Connectivity::from_triangles(49, shape.triangles), frames, {}, rest);
}

class CallOfAnOperation : public testing::Test {
 protected:
  CallOfAnOperation() { add_toolkit(table_); }

  CallRequest request(const std::string& operation) const {
    CallRequest request;
    request.operation = table_.find(operation);
    request.parameters = Parameters(table_.parameters_of(*request.operation));
    return request;
  }

  CallRequest align_of(const MeshSequence& sequence) const {
    CallRequest align = request("align");
    align.given["sequence"] = {{"take", FieldSequence(sequence)}};
    return align;
  }

  Call run(CallRequest request) const {
    Call call(table_, std::move(request));
    call.load();
    call.run();
    call.write();
    return call;
  }

  static const MeshSequence& out_of(Call& call) {
    return std::get<FieldSequence>(call.outcome().outputs.at("out").front().data).sequence();
  }

  fs::path at(const std::string& name) const { return folder_.path() / name; }

  OperationTable table_;
  test::TemporaryFolder folder_;
};

TEST_F(CallOfAnOperation, GivesMotionBackThatAManifestOfAnotherCallTellsOf) {
  const MeshSequence sequence = turning_grid();
  CallRequest align = align_of(sequence);
  align.manifest = Destination{at("align.json")};
  Call aligned = run(align);
  const MeshSequence still = out_of(aligned);
  EXPECT_GT((still.positions() - sequence.positions()).cwiseAbs().maxCoeff(), 0.01);

  CallRequest undo = align_of(still);
  undo.parameters.set("undo", at("align.json").string());
  Call undone = run(undo);
  EXPECT_LT((out_of(undone).positions() - sequence.positions()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(CallOfAnOperation, TellsInItsManifestWhatWasGivenAndWhatWasRead) {
  CallRequest align = align_of(turning_grid());
  align.destinations["out"] = {at("still.npy")};
  run(align);
  const json written = json::parse(std::ifstream(at("still.run.json")));
  EXPECT_EQ(written["given_inputs"], (json{{"sequence", {"take"}}}));
  EXPECT_TRUE(written["named_inputs"].empty());
  EXPECT_TRUE(written["inputs"].empty());
  EXPECT_EQ(written["outputs"], json::array({at("still.npy").string()}));
  EXPECT_EQ(written["result"]["frames"], 5);

  CallRequest again = request("align");
  again.named["sequence"] = {at("still.npy").string()};
  again.manifest = Destination{at("again.json")};
  run(again);
  const json read = json::parse(std::ifstream(at("again.json")));
  EXPECT_EQ(read["named_inputs"], (json{{"sequence", {at("still.npy").string()}}}));
  EXPECT_FALSE(read.contains("given_inputs"));
  EXPECT_EQ(read["inputs"][0]["path"], at("still.npy").string());
}

TEST_F(CallOfAnOperation, WritesWhatItHandsOver) {
  CallRequest align = align_of(turning_grid());
  align.destinations["out"] = {at("still.npy")};
  Call call = run(align);
  CallRequest back = request("convert");
  back.named["sequence"] = {at("still.npy").string()};
  back.wanted = {"out"};
  Call read = run(back);
  EXPECT_EQ(out_of(read).positions(), out_of(call).positions());
}

TEST_F(CallOfAnOperation, RefusesBeforeAnythingIsRead) {
  const auto refusal = [&](const CallRequest& request) {
    return test::message_of<UsageError>([&] { Call(table_, request); });
  };
  EXPECT_THAT(refusal(request("align")), HasSubstr("needs its input 'sequence'"));
  CallRequest table = request("align");
  table.given["sequence"] = {{"rows", Table{}}};
  EXPECT_THAT(refusal(table), HasSubstr("expected the kind 'sequence', found 'table'"));
  CallRequest frames = align_of(turning_grid());
  frames.parameters.set("frames", std::string("0:2"));
  EXPECT_THAT(refusal(frames), HasSubstr("parameter 'frames' is about files"));
  CallRequest format = align_of(turning_grid());
  format.parameters.set("format", std::string("obj"));
  EXPECT_THAT(refusal(format), HasSubstr("parameter 'format' is about files"));
  std::ofstream(at("there.json")) << "{}";
  CallRequest manifest = align_of(turning_grid());
  manifest.manifest = Destination{at("there.json")};
  EXPECT_THAT([&] { Call(table_, manifest); },
              testing::ThrowsMessage<OutputError>(HasSubstr("there.json: exists")));
}

TEST_F(CallOfAnOperation, ReplacesManifestsOfItsOperationThatStandForThemselves) {
  const auto align_to = [&](const fs::path& manifest, bool overwrite) {
    CallRequest align = align_of(turning_grid());
    align.manifest = Destination{manifest, overwrite};
    return align;
  };
  run(align_to(at("align.json"), false));
  EXPECT_NO_THROW(run(align_to(at("align.json"), true)));
  CallRequest other = request("info");
  other.given["sequence"] = {{"take", FieldSequence(turning_grid())}};
  other.manifest = Destination{at("align.json"), true};
  EXPECT_THAT([&] { run(other); },
              testing::ThrowsMessage<OutputError>(HasSubstr("no manifest of a run of 'info'")));

  CallRequest written = align_of(turning_grid());
  written.destinations["out"] = {at("still.npy")};
  run(written);
  EXPECT_THROW(run(align_to(at("still.run.json"), true)), OutputError);
  EXPECT_THROW(run(align_to(at("still.npy"), true)), OutputError);
}

TEST_F(CallOfAnOperation, NeverWritesItsManifestOverAnInputOrAnOutput) {
  run([&] {
    CallRequest align = align_of(turning_grid());
    align.manifest = Destination{at("align.json")};
    return align;
  }());
  CallRequest undo = align_of(turning_grid());
  undo.parameters.set("undo", at("align.json").string());
  undo.manifest = Destination{at("align.json"), true};
  EXPECT_THROW(run(undo), OutputError);

  for (const char* place : {"new.npy", "./new.npy", "no/../new.npy"}) {
    CallRequest align = align_of(turning_grid());
    align.destinations["out"] = {at("new.npy")};
    align.manifest = Destination{at(place)};
    EXPECT_THAT([&] { run(align); }, testing::ThrowsMessage<UsageError>(
                                         HasSubstr("two outputs would be written there")));
    EXPECT_FALSE(fs::exists(at("new.npy")));
  }
}

TEST_F(CallOfAnOperation, SaysWhichFieldsAFormatLeavesOut) {
  std::vector<std::string> warnings;
  CallRequest convert = request("convert");
  FieldSequence shown(turning_grid(),
                      {{"speed", Field::Location::vertices, Eigen::VectorXd::Ones(49)}});
  convert.given["sequence"] = {{"take", shown}};
  convert.destinations["out"] = {at("take.npy")};
  convert.log = [&warnings](LogLevel, const std::string& text) { warnings.push_back(text); };
  run(convert);
  EXPECT_THAT(warnings, testing::ElementsAre(HasSubstr("holds no fields; without speed")));
}

TEST_F(CallOfAnOperation, ConvertsUnitsAndAxesAndSaysSo) {
  CallRequest convert = request("convert");
  convert.given["sequence"] = {{"take", FieldSequence(turning_grid())}};
  convert.parameters.set("scale", 0.5);
  convert.parameters.set("up", std::string("y-to-z"));
  convert.destinations["out"] = {at("take.npz")};
  Call call = run(convert);
  EXPECT_THAT(call.outcome().summary, HasSubstr("positions times 0.5, turned y-to-z"));
  const json report = json::parse(call.outcome().report);
  EXPECT_EQ(report.at("scale"), 0.5);
  EXPECT_EQ(report.at("up"), "y-to-z");
  const Positions given = turning_grid().frame(3), made = out_of(call).frame(3);
  EXPECT_EQ(made.col(0), 0.5 * given.col(0));
  EXPECT_EQ(made.col(1), -0.5 * given.col(2));
  EXPECT_EQ(made.col(2), 0.5 * given.col(1));
}

TEST_F(CallOfAnOperation, ChecksWhatReadingNoticed) {
  for (const int number : {0, 1, 4}) {
    std::ofstream(at("f_" + std::to_string(number) + ".obj"))
        << "v 0 0 0\nv 1 0 0\nv 0 1." << number << " 0\nf 1 2 3\n";
  }
  std::vector<std::string> warnings;
  CallRequest check = request("check");
  check.named["sequence"] = {folder_.path().string()};
  check.log = [&warnings](LogLevel, const std::string& text) { warnings.push_back(text); };
  Call call(table_, check);
  call.load();
  call.run();
  EXPECT_THAT(warnings, testing::ElementsAre(HasSubstr("these numbers: 2 to 3")));
  EXPECT_EQ(json::parse(call.outcome().report).at("warnings"), warnings);
  check.parameters.set("strict", true);
  Call strict(table_, check);
  strict.load();
  EXPECT_THROW(strict.run(), MismatchError);
}

TEST_F(CallOfAnOperation, LeavesNothingBehindWhereTheOperationFails) {
  Operation operation;
  operation.name = "failing";
  operation.inputs = {{"sequence", DataKind::sequence, "a mesh"}};
  operation.outputs = {{"out", DataKind::sequence, "nothing"}};
  operation.run = [](const Invocation&) -> Outcome { throw std::runtime_error("it cannot"); };
  table_.add(operation);
  CallRequest failing = request("failing");
  failing.given["sequence"] = {{"take", FieldSequence(turning_grid())}};
  failing.destinations["out"] = {at("folder") / "out.npy"};
  failing.manifest = Destination{at("manifest.json")};
  EXPECT_THAT([&] { run(failing); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("it cannot")));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(CallOfAnOperation, ReportsProgressFromNothingToAll) {
  std::vector<double> shares;
  CallRequest align = align_of(turning_grid());
  align.destinations["out"] = {at("still.npy")};
  align.context = Context().with_progress([&shares](double share) {
    shares.push_back(share);
    return true;
  });
  run(align);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.front(), 0);
  EXPECT_DOUBLE_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace mimetra
