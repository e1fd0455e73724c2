#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using nlohmann::json;

class Output : public test::QuickCommandTest {};

TEST_F(Output, FolderHoldsNumberedFramesAndTheManifestOnly) {
  ASSERT_EQ(run("convert head --weights take.csv --frames 0:3 -o take").code, 0);
  EXPECT_EQ(listing("take"), (std::set<std::string>{"frame_0000.ply", "frame_0001.ply",
                                                    "frame_0002.ply", "mimetra-run.json"}));
}

TEST_F(Output, ManifestTellsOptionsInputsAndResult) {
  ASSERT_EQ(run("decompose head --weights take.csv -k 2 -o c.h5").code, 0);
  const json manifest = json::parse(text_of(folder_ / "c.run.json"));
  EXPECT_EQ(manifest.at("command"), "decompose");
  EXPECT_EQ(manifest.at("options").at("k"), "2");
  EXPECT_EQ(manifest.at("result").at("components"), 2);
  ASSERT_FALSE(manifest.at("inputs").empty());
  for (const json& input : manifest.at("inputs")) {
    EXPECT_EQ(input.at("xxh3").get<std::string>().size(), 16u);
  }
}

TEST_F(Output, ManifestHashesTheFilesOfOptions) {
  write("options.json", R"({"k": 2})");
  ASSERT_EQ(run("convert head -o neutral.ply").code, 0);
  ASSERT_EQ(run("transfer head --weights take.csv head --source-rest neutral.ply --rest mean "
                "--config options.json -o out")
                .code,
            0);
  std::vector<std::string> files;
  const json manifest = json::parse(text_of(folder_ / "out/mimetra-run.json"));
  for (const json& input : manifest.at("inputs")) {
    files.push_back(input.at("path"));
    EXPECT_EQ(input.at("xxh3").get<std::string>().size(), 16u);
  }
  EXPECT_THAT(files, testing::IsSupersetOf({"take.csv", "neutral.ply", "options.json"}));
  EXPECT_THAT(files, testing::Not(testing::Contains("mean")));
  EXPECT_THAT(files, testing::Contains("take.csv").Times(1));
}

TEST_F(Output, OfATargetWithAFractionalIdentityIsNamedWhole) {
  ASSERT_EQ(
      run("transfer head --weights take.csv head@wide=0.5 head@wide=1.5 -k 2 -o out.v2/").code, 0);
  EXPECT_EQ(listing("out.v2"),
            (std::set<std::string>{"head@wide=0.5", "head@wide=0.5.rest.ply",
                                   "head@wide=0.5.times.csv", "head@wide=1.5",
                                   "head@wide=1.5.rest.ply", "head@wide=1.5.times.csv"}));
  EXPECT_THAT(listing("out.v2/head@wide=0.5"),
              testing::IsSupersetOf({"frame_0011.ply", "mimetra-run.json"}));
}

TEST_F(Output, WithHeadMotionGivenBackKeepsNoNeutral) {
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
  ASSERT_EQ(run("transfer take.npy head --align all --full -o moved.npy").code, 0);
  ASSERT_EQ(run("transfer take.npy head --full -o still.npy").code, 0);
  EXPECT_FALSE(listing().contains("moved.rest.ply"));
  EXPECT_TRUE(listing().contains("still.rest.ply"));
}

TEST_F(Output, IsTheSameOnEveryRun) {
  ASSERT_EQ(
      run("transfer head --weights take.csv head@wide=1 -k 3 -o a --regions-out r/a.pvd").code, 0);
  ASSERT_EQ(
      run("transfer head --weights take.csv head@wide=1 -k 3 -o b --regions-out s/a.pvd").code, 0);
  for (const std::string& name : listing("a")) {
    if (name == "mimetra-run.json") continue;
    EXPECT_EQ(text_of(folder_ / "a" / name), text_of(folder_ / "b" / name)) << name;
  }
  for (const std::string& name : listing("r/a_vtp")) {
    EXPECT_EQ(text_of(folder_ / "r/a_vtp" / name), text_of(folder_ / "s/a_vtp" / name)) << name;
  }
}

TEST_F(Output, IsTheSameForEveryNumberOfThreads) {
  const std::string transfer = "transfer head --weights take.csv head@wide=1 -k 3 ";
  for (const std::string threads : {"1", "2", "3"}) {
    const std::string end = " --threads " + threads;
    ASSERT_EQ(run("decompose head --weights take.csv -k 3 -o c" + threads + ".h5" + end).code, 0);
    ASSERT_EQ(run(transfer + "-o b" + threads + ".npy" + end).code, 0);
    ASSERT_EQ(run(transfer + "--space vertex -o v" + threads + ".npy" + end).code, 0);
    ASSERT_EQ(run("convert b" + threads + ".npy --format obj -o f" + threads + end).code, 0);
    ASSERT_EQ(run("convert f" + threads + " -o g" + threads + ".npy" + end).code, 0);
  }
  for (const std::string name :
       {"c%.h5", "b%.npy", "v%.npy", "f%/frame_0000.obj", "f%/frame_0011.obj", "g%.npy"}) {
    const auto bytes = [&](const char* threads) {
      return text_of(folder_ / std::string(name).replace(1, 1, threads));
    };
    EXPECT_EQ(bytes("1"), bytes("2")) << name;
    EXPECT_EQ(bytes("1"), bytes("3")) << name;
  }
}

TEST_F(Output, IsOnlyPlannedByADryRun) {
  const auto before = listing();
  const auto result =
      run("transfer head --weights take.csv head@wide=1 -k 2 -o out --dry-run --json");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(listing(), before);
  const json plan = json::parse(result.out);
  EXPECT_EQ(plan.at("inputs")[0].at("size"), "12 frames of 225 vertices");
  EXPECT_EQ(plan.at("outputs")[0].at("path"), "out");
  EXPECT_GT(plan.at("memory_bytes").get<double>(), 1e6);
}

TEST_F(Output, IsFollowedByWhatTheRunHasCost) {
  const auto result = run("convert head --weights take.csv -o take.npy");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              testing::ContainsRegex(
                  "read in [0-9.e-]+ s, computed in [0-9.e-]+ s, written in [0-9.e-]+ s, "
                  "at most [0-9]+ MB of memory\n$"));
  // Nothing was written, so that nothing is said of it.
  EXPECT_THAT(run("info take.npy").err, testing::Not(testing::HasSubstr("of memory")));
}

TEST_F(Output, LeavesTheManifestOfAnotherOutputAlone) {
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
  const std::string first = text_of(folder_ / "take.run.json");
  ASSERT_EQ(run("render take.npy --size 32 -o take.png").code, 0);
  EXPECT_EQ(text_of(folder_ / "take.run.json"), first);
  EXPECT_EQ(json::parse(text_of(folder_ / "take.png.run.json")).at("command"), "render");
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy --force").code, 0);
  EXPECT_NE(text_of(folder_ / "take.run.json"), first);
}

TEST_F(Output, QuietPrintsNothing) {
  const auto result = CommandTest::run("convert head --weights take.csv -o take.npy -q");
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Output, ProgressBarIsDrawnOnlyWhenAskedForOffATerminal) {
  const auto drawn = testing::HasSubstr("\r");
  EXPECT_THAT(run("convert head --weights take.csv -o a.npy").err, testing::Not(drawn));
  EXPECT_THAT(run("convert head --weights take.csv -o b.npy --progress always").err, drawn);
}

TEST_F(Output, KeepsInputsThatItsCompanionsWouldReplace) {
  ASSERT_EQ(run("convert head --weights take.csv -o a.npy").code, 0);
  ASSERT_EQ(run("convert head --weights take.csv -o x.npy").code, 0);
  ASSERT_EQ(run("convert head -o n.ply").code, 0);
  std::filesystem::copy_file(folder_ / "n.ply", folder_ / "x.topology.ply",
                             std::filesystem::copy_options::overwrite_existing);
  ASSERT_EQ(run("convert head --weights take.csv -o y/").code, 0);
  ASSERT_EQ(run("regions a.npy -k 2 -o r.pvd").code, 0);
  const std::string topology = text_of(folder_ / "x.topology.ply");
  const std::string rest = text_of(folder_ / "y.rest.ply");
  const std::string frame = text_of(folder_ / "r_vtp/r_0001.vtp");

  const auto other = run("convert a.npy --topology x.topology.ply -o x.npy --force");
  EXPECT_EQ(other.code, 5);
  EXPECT_THAT(other.err, testing::HasSubstr("x.topology.ply: is an input of this run"));
  const auto stale = run("convert y.rest.ply -o y --force");
  EXPECT_EQ(stale.code, 5);
  EXPECT_THAT(stale.err, testing::HasSubstr("y.rest.ply: is an input of this run"));
  const auto series = run("regions r.vtp.series -k 2 -o r.pvd --force");
  EXPECT_EQ(series.code, 5);
  EXPECT_THAT(series.err, testing::HasSubstr("r.vtp.series: is an input of this run"));

  EXPECT_EQ(text_of(folder_ / "x.topology.ply"), topology);
  EXPECT_EQ(text_of(folder_ / "y.rest.ply"), rest);
  EXPECT_EQ(text_of(folder_ / "r_vtp/r_0001.vtp"), frame);
}

TEST_F(Output, MayBeWrittenBesideItsInputWhoseRestPoseItKeeps) {
  ASSERT_EQ(run("convert head --weights take.csv -o a").code, 0);
  const std::string rest = text_of(folder_ / "a.rest.ply");
  ASSERT_EQ(run("convert a -o a.npy").code, 0);
  EXPECT_EQ(run("convert a -o a.npy --force").code, 0);
  EXPECT_EQ(text_of(folder_ / "a.rest.ply"), rest);
}

TEST_F(Output, MayBeReplacedByEveryKindOfRun) {
  for (const std::string arguments : {"sample -o s", "convert head --weights take.csv -o f",
                                      "transfer head --weights take.csv head head@wide=1 -k 2 -o t",
                                      "regions head --weights take.csv -k 2 -o r.pvd"}) {
    ASSERT_EQ(run(arguments).code, 0) << arguments;
    const auto again = run(arguments + " --force");
    EXPECT_EQ(again.code, 0) << arguments << again.err;
  }
}

TEST_F(Output, DoesNotLieInAnotherOne) {
  const auto before = listing();
  const auto nested =
      run("transfer head --weights take.csv head -k 2 -o out --regions-out out/r.pvd");
  EXPECT_EQ(nested.code, 2);
  EXPECT_THAT(nested.err, testing::HasSubstr("out/r.pvd: lies in out, another output"));
  EXPECT_EQ(listing(), before);
}

}  // namespace
}  // namespace mimetra
