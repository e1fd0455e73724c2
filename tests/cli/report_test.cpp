#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class ReportCommand : public test::QuickCommandTest {
 protected:
  /// A transfer by regions; `more` options.
  void transfer(const std::string& out, const std::string& more = "-k 2") const {
    const auto result =
        run("transfer head head@wide=0.5 --weights take.csv " + more + " -o " + out);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(ReportCommand, ShowsWhatATransferWrote) {
  transfer("out");
  const auto result = run("report out -k 3 --json -o page.html");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("has changed")));
  EXPECT_THAT(text_of(folder_ / "page.html"), HasSubstr("<h1>head → head@wide=0.5</h1>"));
  EXPECT_TRUE(listing().contains("page.run.json"));
  // The row of the run itself is what the run measured.
  const json rows = json::parse(result.out).at("rows");
  const json then = json::parse(text_of(folder_ / "out/mimetra-run.json")).at("result");
  EXPECT_EQ(rows.at(0).at("k"), 2);
  EXPECT_NEAR(rows.at(0).at("de_all").get<double>(),
              then.at("targets").at(0).at("de_all").get<double>(), 1e-12);
  EXPECT_EQ(rows.at(0).at("triangles"), then.at("regions").at("triangles"));
}

TEST_F(ReportCommand, FindsARunByAnyOfItsOutputs) {
  transfer("out.npy", "-k 2 --regions-out rois.pvd");
  for (const char* name : {"out.npy", "rois.pvd", "out.run.json"}) {
    const auto result = run("report " + std::string(name) + " -k 2 --force -o page.html");
    EXPECT_EQ(result.code, 0) << name << ": " << result.err;
  }
}

TEST_F(ReportCommand, TakesTheOneRunByRegionsOfAFolderWhateverManifestsAreBeside) {
  transfer("all/full", "--full");
  transfer("all/part", "-k 2 --regions-out all/part.json");
  write("all/train.run.json", "{\"loss\": 1}");
  write("all/old.run.json", "not JSON");
  std::filesystem::create_symlink("nowhere", folder_ / "all/lost.run.json");
  const auto result = run("report all -k 2 -o page.html");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(text_of(folder_ / "page.html"), HasSubstr("--regions-out all/part.json"));
}

TEST_F(ReportCommand, NamesAnInputThatHasChanged) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o rois.pvd").code, 0);
  std::string weights = text_of(folder_ / "take.csv");
  weights.insert(weights.find_last_of("0123456789"), "0");
  write("take.csv", weights);
  const auto result = run("report rois.pvd -o page.html");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("take.csv: has changed since rois.run.json was written"));
  EXPECT_THAT(text_of(folder_ / "page.html"), HasSubstr("<li>take.csv</li>"));
}

TEST_F(ReportCommand, RefusesAManifestThatLacksAnInput) {
  transfer("out");
  json manifest = json::parse(text_of(folder_ / "out/mimetra-run.json"));
  manifest["named_inputs"]["target"] = json::array();
  write("broken.run.json", manifest.dump());
  const auto result = run("report broken.run.json -o page.html");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("broken.run.json: names no target of the run"));
}

TEST_F(ReportCommand, AsksWhichOfSeveralRuns) {
  transfer("all/two", "-k 2");
  transfer("all/three", "-k 3");
  const auto result = run("report all -o page.html");
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, HasSubstr("all: holds 2 runs of transfer; name one: "
                                    "all/three/mimetra-run.json, all/two/mimetra-run.json"));
}

TEST_F(ReportCommand, ShowsTheTargetThatIsNamed) {
  ASSERT_EQ(run("transfer head head@wide=0.5 head@wide=1 --weights take.csv -k 2 -o out").code, 0);
  ASSERT_EQ(run("report out/head@wide=1 -k 2 -o page.html").code, 0);
  EXPECT_THAT(text_of(folder_ / "page.html"), HasSubstr("<h1>head → head@wide=1</h1>"));
  ASSERT_EQ(run("report out/head@wide=1/mimetra-run.json -k 2 --force -o page.html").code, 0);
  EXPECT_THAT(text_of(folder_ / "page.html"), HasSubstr("<h1>head → head@wide=1</h1>"));
}

TEST_F(ReportCommand, ShowsAnEvaluationAndRegions) {
  ASSERT_EQ(run("evaluate head head@wide=0.5 --weights take.csv -k 2,3 -o table.csv").code, 0);
  const auto table = run("report table.csv -k 1 --json -o table.html");
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_EQ(json::parse(table.out).at("rows").size(), 4u);
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o rois.pvd").code, 0);
  const auto regions = run("report rois.pvd --json -o rois.html");
  ASSERT_EQ(regions.code, 0) << regions.err;
  EXPECT_FALSE(json::parse(regions.out).contains("rows"));
}

TEST_F(ReportCommand, RefusesWhatNoRunHasWritten) {
  EXPECT_EQ(run("report nothing -o page.html").code, 3);
  const auto mesh = run("report head/neutral.ply -o page.html");
  EXPECT_EQ(mesh.code, 3);
  EXPECT_THAT(mesh.err, HasSubstr("no manifest of a run of mimetra beside it"));
  const auto folder = run("report head -o page.html");
  EXPECT_EQ(folder.code, 3);
  EXPECT_THAT(folder.err, HasSubstr("no run that looked for regions"));
  write("x.run.json", "{}");
  const auto manifest = run("report x.run.json -o page.html");
  EXPECT_EQ(manifest.code, 3);
  EXPECT_THAT(manifest.err, HasSubstr("expected the manifest of a run of mimetra"));
  EXPECT_FALSE(listing().contains("page.html"));
}

TEST_F(ReportCommand, NamesAnInputThatIsGone) {
  transfer("out");
  std::filesystem::rename(folder_ / "take.csv", folder_ / "moved.csv");
  const auto result = run("report out -o page.html");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err,
              HasSubstr("take.csv: no such file; out/mimetra-run.json was made from it"));
}

TEST_F(ReportCommand, RefusesFullTransfersAndOtherRuns) {
  transfer("full", "--full");
  const auto full = run("report full -o page.html --dry-run");
  EXPECT_EQ(full.code, 4);
  EXPECT_THAT(full.err, HasSubstr("full/mimetra-run.json: was made with --full"));
  ASSERT_EQ(run("convert head --weights take.csv -o copy").code, 0);
  const auto copy = run("report copy -o page.html");
  EXPECT_EQ(copy.code, 4);
  EXPECT_THAT(copy.err, HasSubstr("a run of convert; expected one of transfer, evaluate"));
  EXPECT_EQ(run("report full -o page.png").code, 2);
}

}  // namespace
}  // namespace mimetra
