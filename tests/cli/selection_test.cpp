#include <map>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

/// Regions by energy and for the transfer, by the command.
class SelectionTest : public test::QuickCommandTest {
 protected:
  Json report(const std::string& arguments) const {
    const test::CommandResult result = run(arguments + " --json");
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(result.out);
  }

  void expect_usage(const std::string& arguments, const std::string& message) const {
    const auto before = listing();
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.code, 2) << arguments << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(listing(), before);
  }

  std::string transfer(const std::string& options) const {
    return "transfer head --weights take.csv head@wide=1 -o out.npy --force " + options;
  }
  std::string evaluate(const std::string& options) const {
    return "evaluate head --weights take.csv head@wide=1 " + options;
  }
  std::string regions(const std::string& options) const {
    return "regions head --weights take.csv -o r.json --force " + options;
  }
};

TEST_F(SelectionTest, KeepsTheShareOfTheTriangles) {
  for (const std::string select : {"energy", "transfer"}) {
    for (const double share : {0.3, 0.6}) {
      const Json result =
          report(transfer("--select " + select + " --triangles " + std::to_string(share)));
      EXPECT_LE(result["regions"]["triangle_share"], share);
      EXPECT_GT(result["regions"]["triangle_share"], 0);
      EXPECT_EQ(result["targets"][0]["triangle_share"], result["regions"]["triangle_share"]);
    }
  }
}

TEST_F(SelectionTest, TakesNoMoreDiscsThanAsked) {
  const Json two = report(transfer("--select transfer -k 2"));
  EXPECT_EQ(two["regions"]["regions"].size(), 2U);
  const Json rows = report(evaluate("--select transfer -k 2,4"))["rows"];
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["k"], 2);
  EXPECT_EQ(rows[0]["by"], "transfer");
  EXPECT_EQ(rows[1]["k"], 4);
  EXPECT_TRUE(rows[2]["by"].is_null());
}

TEST_F(SelectionTest, RegionsAreThoseThatTransferSolvesBy) {
  const std::string choice = "--select transfer --triangles 0.35 ";
  const Json found = report(regions(choice + "--target head@wide=1"));
  const Json result = report(transfer(choice + "--regions-out own.json"));
  EXPECT_EQ(result["regions"]["regions"], found["regions"]);
  const Json by_file = report(transfer("--complete 0 --regions r.json"));
  EXPECT_EQ(by_file["targets"][0]["de_all"], result["targets"][0]["de_all"]);
  const Json by_own = report(transfer("--complete 0 --regions own.json"));
  EXPECT_EQ(by_own["targets"][0]["de_all"], result["targets"][0]["de_all"]);
  const Json row = report(evaluate(choice))["rows"][0];
  EXPECT_EQ(row["de_all"], result["targets"][0]["de_all"]);
  EXPECT_EQ(row["triangle_share"], found["triangle_share"]);
}

TEST_F(SelectionTest, GivesEachTargetItsOwn) {
  const std::string both = "transfer head --weights take.csv head head@wide=2 -o both/ ";
  const Json result = report(both + "--select transfer --triangles 0.3");
  EXPECT_FALSE(result.contains("regions"));
  for (const Json& target : result["targets"]) {
    EXPECT_EQ(target["regions"]["triangle_share"], target["triangle_share"]);
  }
  expect_usage(both + "--force --select transfer --regions-out r.json",
               "each target has regions of its own");
}

TEST_F(SelectionTest, ReportsWhatIsLeftWhereDiscsTookTheRoom) {
  ASSERT_EQ(run("sample -o sample").code, 0);
  const std::string source = "transfer sample --weights sample/performance.csv --frames 0:10 ";
  const std::string one = source + "sample@identity001=1 ";
  const std::string bound = "-k 5 --iterations 2 --triangles 0.1 ";
  const Json result = report(one + bound + "-o a/ --regions-out own.json");
  EXPECT_GT(result["targets"][0]["added_regions"].size(), 0U);
  EXPECT_LE(result["regions"]["triangle_share"], 0.1);
  EXPECT_EQ(result["targets"][0]["triangle_share"], result["regions"]["triangle_share"]);
  const Json again = report(one + "--regions own.json --complete 0 -o b/");
  EXPECT_EQ(again["targets"][0]["de_all"], result["targets"][0]["de_all"]);
  const std::string two = one + "sample@identity002=1 " + bound;
  for (const Json& target : report(two + "-o c/")["targets"].get<std::vector<Json>>()) {
    EXPECT_EQ(target["regions"]["triangle_share"], target["triangle_share"]);
  }
  expect_usage(two + "-o d/ --regions-out r.json", "each target has regions of its own");
}

TEST_F(SelectionTest, ForeseesInADryRunWhatItRefuses) {
  expect_usage(evaluate("--curve -k 5 --dry-run"), "--curve has rows");
  expect_usage(evaluate("--select transfer --coverage 0.3 --dry-run"), "--coverage: has no effect");
  expect_usage(evaluate("--per-region --symmetry 1 --dry-run"), "--symmetry: weights of each");
  EXPECT_EQ(run(evaluate("--exclusive eyes --dry-run")).code, 4);
  expect_usage(regions("--select transfer --dry-run"), "--target MODEL");
  expect_usage(regions("--select transfer --target head --coverage 0.3 --dry-run"), "--coverage");
  ASSERT_EQ(run("convert head -o mesh.ply").code, 0);
  EXPECT_EQ(run(regions("--select transfer --target mesh.ply --dry-run")).code, 4);
  write("square.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  EXPECT_EQ(run(regions("--select transfer --target square.obj --dry-run")).code, 4);
  EXPECT_EQ(run(regions("--only group:no --dry-run")).code, run(regions("--only group:no")).code);
  EXPECT_EQ(run(transfer("--only group:no --dry-run")).code, run(transfer("--only group:no")).code);
  EXPECT_NE(run(transfer("--only group:no --dry-run")).code, 0);
  write("r.vtp.series", "mine");
  const auto planned = run("regions head --weights take.csv -k 2 -o r.pvd --dry-run");
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_THAT(planned.err, HasSubstr("r.vtp.series: stands without 'r.pvd'"));
  EXPECT_FALSE(listing().contains("r.json"));
}

TEST_F(SelectionTest, ServesTheTransferBetterThanEnergyOnTheSample) {
  ASSERT_EQ(run("sample -o sample").code, 0);
  const std::string evaluate =
      "evaluate sample --weights sample/performance.csv --frames 0:120:4 sample@identity002=1 "
      "--triangles 0.25 ";
  const test::CommandResult energy = run(evaluate + "-k 40 --json");
  ASSERT_EQ(energy.code, 0) << energy.err;
  const Json by_energy = Json::parse(energy.out)["rows"][0];
  const Json by_transfer = report(evaluate + "--select transfer")["rows"][0];
  EXPECT_LE(by_transfer["triangle_share"], 0.25);
  EXPECT_LE(by_energy["triangle_share"], 0.25);
  EXPECT_LT(by_transfer["de_all"], by_energy["de_all"]);
}

TEST_F(SelectionTest, RefusesOptionsWithoutEffect) {
  expect_usage(transfer("--full --select transfer"), "--select: no regions are looked for");
  expect_usage(transfer("--full --triangles 0.2"), "--triangles: no regions are looked for");
  ASSERT_EQ(run(regions("")).code, 0);
  expect_usage(transfer("--regions r.json --triangles 0.2"), "--triangles: no regions");
  expect_usage(transfer("--regions r.json --select energy"), "--select: no regions");
  expect_usage(transfer("--regions r.json --full"), "--regions: --full takes all triangles");
  expect_usage(transfer("--regions r.json -k 3"), "-k: no regions are looked for");
  ASSERT_EQ(run("decompose head --weights take.csv -k 3 -o c.h5").code, 0);
  expect_usage(transfer("--regions r.json --components c.h5"), "--components: no regions");
  expect_usage(transfer("--components c.h5 -k 2"), "-k: has no effect on --components");
  expect_usage(regions("--components c.h5 --d-max 0.3"), "--d-max: has no effect on --components");
  for (const std::string option :
       {"--coverage 0.5", "--region support", "--drop-rims", "--d-min 0.2", "--iterations 3",
        "--complete 0.1", "--rest first", "--compat splocs2013"}) {
    const std::string name = option.substr(0, option.find(' '));
    expect_usage(transfer("--select transfer " + option), name);
    expect_usage(transfer("--select transfer " + option), "--select transfer");
  }
  expect_usage(transfer("--select transfer --components-out c.h5"), "there are no components");
  expect_usage(transfer("--select transfer --space vertex"), "--select transfer");
  expect_usage(evaluate("--curve -k 3"), "-k: --curve");
  expect_usage(evaluate("--curve --select transfer"), "--select: --curve");
  expect_usage(evaluate("--curve --triangles 0.3"), "--triangles: --curve");
  expect_usage(evaluate("--curve --space vertex"), "--curve");
  expect_usage(regions("--select transfer"), "--target MODEL");
  expect_usage(regions("--target head"), "use --select transfer");
  expect_usage(regions("--index-base 1"), "use --select transfer");
}

TEST_F(SelectionTest, RefusesAShareOutOfRange) {
  for (const std::string share : {"0", "-0.1", "1.5", "some"}) {
    expect_usage(transfer("--triangles " + share), "--triangles");
  }
}

TEST_F(SelectionTest, RefusesATargetWithoutExpressions) {
  ASSERT_EQ(run("convert head -o mesh.ply").code, 0);
  for (const std::string command :
       {"transfer head --weights take.csv mesh.ply -o out.npy --select transfer",
        "evaluate head --weights take.csv mesh.ply --select transfer",
        "evaluate head --weights take.csv mesh.ply --curve",
        "regions head --weights take.csv -o r.json --select transfer --target mesh.ply"}) {
    const test::CommandResult result = run(command);
    EXPECT_EQ(result.code, 4) << command << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr("is solved for vertices"));
    EXPECT_THAT(result.err, HasSubstr("use --select energy"));
  }
}

TEST_F(SelectionTest, RefusesAShareThatHoldsNoRegion) {
  for (const std::string select : {"energy", "transfer"}) {
    const test::CommandResult result = run(transfer("--triangles 0.0001 --select " + select));
    EXPECT_EQ(result.code, 4) << result.err;
    EXPECT_THAT(result.err, HasSubstr("--triangles: "));
    EXPECT_THAT(result.err, HasSubstr("--radius"));
  }
}

TEST_F(SelectionTest, DrawsTheCurve) {
  const Json result = report(evaluate("--curve --radius 0.08 -o curve.png"))["rows"];
  EXPECT_EQ(text_of(folder_ / "curve.png").substr(1, 3), "PNG");
  std::map<std::string, std::vector<double>> shares;
  for (const Json& row : result) {
    if (!row["by"].is_null()) shares[row["by"]].push_back(row["triangle_share"]);
  }
  EXPECT_FALSE(shares["energy"].empty());
  EXPECT_GT(shares["transfer"].size(), 3U);
  for (const auto& [by, reached] : shares) {
    for (const double share : reached) EXPECT_LE(share, 0.8) << by;
  }
  EXPECT_EQ(result.back()["triangle_share"], 1);
}

}  // namespace
}  // namespace mimetra
