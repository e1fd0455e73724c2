// Third-party operations: what the table takes of plugins, and what becomes of those that do
// something wrong.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugins/c/plugins.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The toolkit's table with the plugins of a folder, and what was left out.
struct Loaded {
  OperationTable table;
  std::vector<std::string> problems;

  explicit Loaded(const std::vector<fs::path>& folders) {
    add_toolkit(table);
    problems = add_plugins(table, folders);
  }
};

const fs::path kPlugins = MIMETRA_TEST_PLUGINS;

TEST(PluginFolders, ThatOthersMayWriteToAreOfNoInstallation) {
  const test::TemporaryFolder folder;
  const fs::path plugins = folder / "lib/mimetra/plugins", binary = folder / "mimetra";
  fs::create_directories(plugins);
  std::ofstream(binary) << "program";
  fs::permissions(plugins, fs::perms(0755));
  EXPECT_TRUE(is_of_installation(plugins, binary));
  fs::permissions(plugins, fs::perms(0777));
  EXPECT_FALSE(is_of_installation(plugins, binary));
  EXPECT_FALSE(is_of_installation(folder / "none", binary));
}

/// A folder that holds one of the broken plugins.
fs::path broken(const std::string& name) {
  return kPlugins / "broken" / name;
}

MeshSequence take() {
  const test::Shape shape = test::grid(4, 3);
  Frames frames(2, shape.positions.size());
  frames.row(0) = shape.positions.reshaped<Eigen::RowMajor>();
  frames.row(1) = 2 * frames.row(0);
  const int vertices = static_cast<int>(shape.positions.rows());
  return {Connectivity::from_triangles(vertices, shape.triangles), frames};
}

Outcome misbehave(const std::string& how, const Context& context = {}) {
  static const Loaded loaded({kPlugins / "misbehaving"});
  const Operation& operation = *loaded.table.find("misbehave");
  Invocation invocation;
  invocation.inputs["sequence"] = {{"take", FieldSequence(take())}};
  invocation.parameters = Parameters(loaded.table.parameters_of(operation));
  invocation.parameters.set("how", how);
  invocation.context = context;
  return operation.run(invocation);
}

TEST(Plugins, AddTheirOperations) {
  const Loaded loaded({kPlugins / "samples"});
  EXPECT_THAT(loaded.problems, IsEmpty());
  const Operation* smooth = loaded.table.find("smooth");
  ASSERT_NE(smooth, nullptr);
  ASSERT_EQ(smooth->parameters.size(), 2u);
  EXPECT_EQ(smooth->parameters[0].name, "strength");
  EXPECT_EQ(std::get<double>(smooth->parameters[0].fallback), 0.5);
  EXPECT_EQ(smooth->parameters[0].maximum, 1);
  EXPECT_EQ(std::get<std::int64_t>(smooth->parameters[1].fallback), 1);
  EXPECT_FALSE(smooth->outputs[0].fields);
  ASSERT_NE(loaded.table.find("speed"), nullptr);
  EXPECT_EQ(loaded.table.find("speed")->outputs[0].kind, DataKind::sequence);
  EXPECT_TRUE(loaded.table.find("speed")->outputs[0].fields);
}

TEST(Plugins, InTwoFoldersAreTakenOnce) {
  const Loaded loaded({kPlugins / "samples", kPlugins / "samples" / "."});
  EXPECT_THAT(loaded.problems, IsEmpty());
}

struct Broken {
  const char* folder;
  const char* problem;
};

class BrokenPlugin : public testing::TestWithParam<Broken> {};

TEST_P(BrokenPlugin, IsReportedAndLeftOut) {
  const Loaded loaded({broken(GetParam().folder), kPlugins / "samples"});
  EXPECT_THAT(loaded.problems,
              ElementsAre(AllOf(HasSubstr(GetParam().folder), HasSubstr(GetParam().problem),
                                HasSubstr("; it is left out"))));
  EXPECT_EQ(loaded.table.find("of-other-version"), nullptr);
  EXPECT_NE(loaded.table.find("smooth"), nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Plugins, BrokenPlugin,
    testing::Values(Broken{"OTHER_VERSION", "is for version 2 of the interface, expected 1"},
                    Broken{"NO_FUNCTION", "has no function mimetra_get_plugin"},
                    Broken{"MISSING_SYMBOL", "nobody_defines_this"},
                    Broken{"RETURNS_NULL", "mimetra_get_plugin returned NULL"},
                    Broken{"THROWS", "no licence"},
                    Broken{"TAKEN_NAME", "there is an operation 'transfer' already"}),
    [](const auto& broken_one) { return std::string(broken_one.param.folder); });

TEST(Plugins, KeepWhatIsSoundBesideWhatIsNot) {
  const Loaded loaded({broken("TAKEN_NAME")});
  EXPECT_NE(loaded.table.find("beside-a-taken-name"), nullptr);
  EXPECT_EQ(loaded.table.find("transfer")->outputs.size(), 4u);
}

TEST(Plugins, WithImpossibleDescriptionsAreLeftOut) {
  const Loaded loaded({broken("DESCRIPTIONS")});
  EXPECT_THAT(
      loaded.problems,
      ElementsAre(HasSubstr("an operation has the name ''"), HasSubstr("'Has Blanks'"),
                  HasSubstr("'no-run' has no function to run"), HasSubstr("the kind 99"),
                  HasSubstr("an input has the name ''"), HasSubstr("'sequence' is there twice"),
                  HasSubstr("'json' is an option of every command"), HasSubstr("found '7'"),
                  HasSubstr("'frames' means two things"), HasSubstr("'format' means two things"),
                  HasSubstr("'weights' is there twice"), HasSubstr("has the choice 'don't'"),
                  HasSubstr("no line of UTF-8"), HasSubstr("the choice 'npy' twice"),
                  HasSubstr("has no choices")));
  Loaded none({});
  EXPECT_EQ(loaded.table.operations().size(), none.table.operations().size());
}

TEST(Plugins, ThatAreNoLibrariesAreReported) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "text.so") << "not a library";
  std::ofstream(folder.path() / "text.txt") << "not looked at";
  EXPECT_THAT(Loaded({folder.path()}).problems, ElementsAre(HasSubstr("text.so")));
  EXPECT_THAT(Loaded({folder.path() / "none"}).problems, ElementsAre(HasSubstr("no such folder")));
}

TEST(Plugins, HaveWholeNumbersOf32Bits) {
  const Loaded loaded({kPlugins / "kinds"});
  const Parameter& seed = loaded.table.find("spots")->parameters.at(0);
  EXPECT_EQ(seed.maximum, std::numeric_limits<std::int32_t>::max());
  EXPECT_NO_THROW(parse_value(seed, "2147483647"));
  EXPECT_THROW(parse_value(seed, "2147483648"), UsageError);
}

TEST(Plugins, AreTakenBesideALinkThatLeadsNowhere) {
  const test::TemporaryFolder folder;
  fs::create_symlink("loop.so", folder.path() / "loop.so");
  fs::copy_file(kPlugins / "samples" / "smooth.so", folder.path() / "smooth.so");
  const Loaded loaded({folder.path()});
  EXPECT_THAT(loaded.problems, ElementsAre(HasSubstr("loop.so")));
  EXPECT_NE(loaded.table.find("smooth"), nullptr);
}

TEST(PluginFolders, AreThoseOfTheEnvironment) {
  setenv("MIMETRA_PLUGIN_PATH", "/a::/b/c", 1);
  EXPECT_THAT(plugin_folders(), AllOf(Contains(fs::path("/a")), Contains(fs::path("/b/c"))));
  unsetenv("MIMETRA_PLUGIN_PATH");
  EXPECT_THAT(plugin_folders(), testing::Not(Contains(fs::path("/a"))));
}

template <typename Error>
std::string message_of(const std::string& how) {
  try {
    misbehave(how);
  } catch (const Error& error) {
    return error.what();
  }
  return "no such exception";
}

TEST(PluginRun, ThatIsSoundGivesItsValue) {
  const Outcome outcome = misbehave("well");
  const auto& made = std::get<FieldSequence>(outcome.outputs.at("out").front().data);
  EXPECT_EQ(made.sequence().vertices(), 3);
  EXPECT_EQ(outcome.report, "{}");
}

TEST(PluginRun, ThrowingEndsAlone) {
  EXPECT_EQ(message_of<std::runtime_error>("throw"),
            "misbehaving: misbehave: threw an exception: of the plugin");
  EXPECT_THAT(message_of<std::runtime_error>("throw-number"), HasSubstr("is no std::exception"));
  EXPECT_THAT(message_of<std::runtime_error>("throw-memory"), HasSubstr("not enough memory"));
  EXPECT_NO_THROW(misbehave("well"));
}

TEST(PluginRun, FailsWithItsOwnStatusAndWords) {
  EXPECT_EQ(message_of<MismatchError>("refuse"), "misbehaving: misbehave: one eye is closed");
  EXPECT_THAT(message_of<MismatchError>("silent"), HasSubstr("does not say why"));
  EXPECT_THAT(message_of<std::runtime_error>("status"), HasSubstr("the status 77"));
  EXPECT_THROW(misbehave("cancel"), Cancelled);
}

TEST(PluginRun, IsCancelledHoweverItTellsSo) {
  const Context never = Context().with_progress([](double) { return false; });
  for (const char* how : {"throw-when-cancelled", "fail-when-cancelled", "percent"}) {
    EXPECT_THROW(misbehave(how, never), Cancelled) << how;
    EXPECT_NO_THROW(misbehave(how)) << how;
  }
}

TEST(PluginRun, ReportsProgressFromNothingToAll) {
  std::vector<double> shares;
  misbehave("percent", Context().with_progress([&shares](double share) {
    shares.push_back(share);
    return true;
  }));
  EXPECT_THAT(shares, ElementsAre(1, 0, 0));
}

TEST(PluginRun, HandsBackNothingThatCannotBe) {
  EXPECT_THAT(message_of<IoError>("nan"), HasSubstr("holds nan at [2, 2]"));
  EXPECT_THAT(message_of<UsageError>("name"), HasSubstr("needs the array 'positions'"));
  EXPECT_THAT(message_of<UsageError>("kind"), HasSubstr("expected the kind 'table'"));
  EXPECT_THAT(message_of<UsageError>("null"), HasSubstr("is NULL"));
  EXPECT_THAT(message_of<UsageError>("report"), HasSubstr("the report: expected JSON: line 1"));
  EXPECT_THAT(message_of<UsageError>("no-utf8"), HasSubstr("the summary is no UTF-8: ??"));
  EXPECT_THAT(message_of<MismatchError>("fail-in-no-utf8"), HasSubstr("misbehave: ?!"));
  EXPECT_THAT(message_of<std::runtime_error>("twice"), HasSubstr("made 2 values"));
  EXPECT_THAT(message_of<std::runtime_error>("nothing"), HasSubstr("made 0 values of its output"));
  EXPECT_THAT(message_of<std::runtime_error>("ignored-nan"),
              AllOf(HasSubstr("made 0 values"), HasSubstr("its last error: made: array")));
}

TEST(PluginRun, HasItsRegionsShownOnTheSequenceOfTheirTriangles) {
  const Loaded loaded({kPlugins / "kinds"});
  const Operation& spots = *loaded.table.find("spots");
  // The plugin is given a quad, and returns values of its triangles.
  const Polygons quad{{0, 1, 2, 3}, {0, 4}};
  Frames frames(1, 12);
  frames << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  const MeshSequence sequence(Connectivity::from_polygons(4, quad), frames);
  Invocation invocation;
  invocation.inputs["sequence"] = {{"take", FieldSequence(sequence)}};
  invocation.parameters = Parameters(loaded.table.parameters_of(spots));
  invocation.wanted["out"];
  const Outcome outcome = spots.run(invocation);
  const auto& made = std::get<RegionData>(outcome.outputs.at("out").front().data);
  EXPECT_EQ(made.fields.sequence().shared_connectivity(), sequence.shared_connectivity());
  EXPECT_EQ(made.fields.fields.front().name, "region");
}

TEST(PluginRun, GetsNothingForNamesThatItDidNotDeclare) {
  EXPECT_NO_THROW(misbehave("unknown"));
}

TEST(PluginRun, GetsLengthsInTheUnitOfItsInput) {
  // Half of the diameter of a grid of 3 by 2.
  EXPECT_EQ(misbehave("radius").report, "{\"radius\": 1.802776}");
}

TEST(SmoothSample, MovesVerticesTowardsTheirNeighbours) {
  const Loaded loaded({kPlugins / "samples"});
  const Operation& smooth = *loaded.table.find("smooth");
  const MeshSequence input = take();
  Invocation invocation;
  invocation.inputs["sequence"] = {{"take", FieldSequence(input)}};
  invocation.parameters = Parameters(loaded.table.parameters_of(smooth));
  invocation.parameters.set("strength", 1.0);
  invocation.wanted["out"];
  const auto run = [&] {
    const Outcome outcome = smooth.run(invocation);
    return std::get<FieldSequence>(outcome.outputs.at("out").front().data).sequence();
  };
  const MeshSequence all = run();
  // A plane stays one, and a frame twice as large moves twice as far.
  EXPECT_LT(all.positions().rightCols(1).norm(), 1e-12);
  EXPECT_LT((2 * all.frame(0) - all.frame(1)).norm(), 1e-12);
  // An inner vertex of a regular grid is the mean of its neighbours.
  EXPECT_LT((all.frame(0).row(5) - input.frame(0).row(5)).norm(), 1e-12);
  EXPECT_GT((all.frame(0).row(0) - input.frame(0).row(0)).norm(), 0.1);
  EXPECT_EQ(all.times(), input.times());
  EXPECT_EQ(all.connectivity().polygons, input.connectivity().polygons);
  invocation.parameters.set("strength", 0.0);
  EXPECT_EQ(run().positions(), input.positions());
  invocation.context = Context().with_progress([](double) { return false; });
  EXPECT_THROW(run(), Cancelled);
}

}  // namespace
}  // namespace mimetra
