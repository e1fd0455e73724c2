#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"
#include "tests/image_bytes.h"

namespace mimetra {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// Regions as somebody painted them, by the command.
class PaintTest : public test::QuickCommandTest {
 protected:
  static constexpr int kSide = 15;

  void SetUp() override {
    CommandTest::SetUp();
    std::string table = "vertex,weight\n", list;
    for (int v = 0; v < kSide * kSide; ++v) {
      if (weight(v) > 0) table += std::to_string(v) + ',' + std::to_string(weight(v)) + '\n';
      list += std::to_string(weight(v)) + '\n';
    }
    write("w.csv", table);
    write("w.txt", list);
  }

  /// 1 in the first three columns, 1/2 and 1/4 in the next two.
  static double weight(int v) {
    const int column = v % kSide;
    return column < 3 ? 1 : column == 3 ? 0.5 : column == 4 ? 0.25 : 0;
  }

  /// Frames of the head with texture coordinates on the centres of 15 x 15 pixels.
  void write_textured_takes() const {
    const MorphableModel head = model();
    const Eigen::MatrixXd& bumps = head.average().expressions().displacements;
    for (int frame = 0; frame < 3; ++frame) {
      std::ostringstream text;
      for (int v = 0; v < kSide * kSide; ++v) {
        const Eigen::RowVector3d place = head.average().neutral().row(v) +
                                         0.5 * frame * bumps.col(0).segment<3>(3 * v).transpose();
        const int row = v / kSide;
        text << "v " << place << "\nvt " << (v % kSide + 0.5) / kSide << ' ' << (row + 0.5) / kSide
             << '\n';
      }
      for (const auto& corners : head.average().triangles().rowwise()) {
        text << 'f';
        for (const int v : corners) text << ' ' << v + 1 << '/' << v + 1;
        text << '\n';
      }
      write("take_" + std::to_string(frame) + ".obj", text.str());
    }
  }

  Json report(const std::string& arguments) const {
    const test::CommandResult result = run(arguments + " --json");
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(result.out);
  }

  void expect_failure(const std::string& arguments, int code,
                      const std::vector<std::string>& messages) const {
    const auto before = listing();
    for (const std::string more : {"", " --dry-run"}) {
      const test::CommandResult result = run(arguments + more);
      EXPECT_EQ(result.code, code) << arguments << more << '\n' << result.err;
      for (const std::string& message : messages) {
        EXPECT_THAT(result.err, HasSubstr(message)) << arguments << more;
      }
    }
    EXPECT_EQ(listing(), before);
  }

  static std::string transfer(const std::string& options) {
    return "transfer head --weights take.csv head@wide=1 -o out.npy --force " + options;
  }
  static std::string evaluate(const std::string& options) {
    return "evaluate head --weights take.csv head@wide=1 " + options;
  }
};

TEST_F(PaintTest, SaysWhereTheWeightsCameFromAndHowManyThereAre) {
  for (const std::string file : {"w.csv", "w.txt"}) {
    const Json weight = report(transfer("--paint " + file))["targets"][0]["weight"];
    EXPECT_EQ(weight, Json({{"paint", file},
                            {"falloff", nullptr},
                            {"one", 3 * kSide},
                            {"between", 2 * kSide},
                            {"zero", 10 * kSide}}));
    const Json manifest = Json::parse(text_of(folder_ / "out.run.json"));
    EXPECT_EQ(manifest["options"]["paint"], file);
    EXPECT_EQ(manifest["result"]["targets"][0]["weight"], weight);
    const auto is_file = [&file](const Json& input) { return input["path"] == file; };
    ASSERT_EQ(std::ranges::count_if(manifest["inputs"], is_file), 1);
    EXPECT_FALSE((*std::ranges::find_if(manifest["inputs"], is_file))["xxh3"].empty());
  }
  const Json faded = report(transfer("--paint w.csv --falloff 0.3"))["targets"][0]["weight"];
  EXPECT_EQ(faded["falloff"], "0.3");
  EXPECT_EQ(faded["one"], 3 * kSide);
  EXPECT_GT(faded["between"], 2 * kSide);
}

TEST_F(PaintTest, SaysWhereNothingIsPaintedMuch) {
  std::string faint;
  for (int v = 0; v < kSide * kSide; ++v) faint += std::to_string(weight(v) / 100) + '\n';
  write("faint.txt", faint);
  const std::string warning = "the largest weight is 0.01, so that at most 1.0 % of the motion";
  EXPECT_THAT(run(transfer("--paint faint.txt")).err, HasSubstr(warning));
  EXPECT_THAT(run(transfer("--paint w.txt")).err, testing::Not(HasSubstr("largest weight")));
}

TEST_F(PaintTest, TakesAPictureInTheSourcesTextureSpace) {
  write_textured_takes();
  std::vector<std::uint8_t> grey;
  for (int row = kSide - 1; row >= 0; --row) {
    for (int column = 0; column < kSide; ++column) {
      grey.push_back(row < 4 ? 255 : row == 4 ? 51 : 0);
    }
  }
  std::ofstream(folder_ / "paint.png", std::ios::binary)
      << test::png_bytes(kSide, kSide, PNG_FORMAT_GRAY, grey);
  const Json result =
      report("transfer take_%d.obj head -o out.npy --paint paint.png --regions-out regions.json");
  EXPECT_EQ(result["targets"][0]["weight"]["one"], 4 * kSide);
  EXPECT_EQ(result["targets"][0]["weight"]["between"], kSide);
  const Json regions = Json::parse(text_of(folder_ / "regions.json"));
  ASSERT_EQ(regions["weights"].size(), std::size_t{kSide * kSide});
  EXPECT_EQ(regions["weights"][0], 1);
  EXPECT_EQ(regions["weights"][4 * kSide], 0.2);
  EXPECT_EQ(regions["weights"][5 * kSide], 0);
}

TEST_F(PaintTest, TakesAFieldOfTheSource) {
  ASSERT_EQ(run(transfer("--paint w.csv --regions-out painted.pvd")).code, 0);
  const Json again = report("transfer painted.pvd head@wide=1 -o again.npy --paint field:weight");
  EXPECT_EQ(again["targets"][0]["weight"]["one"], 3 * kSide);
  EXPECT_EQ(again["targets"][0]["weight"]["between"], 2 * kSide);
  expect_failure("transfer painted.pvd head@wide=1 -o x --paint field:weigth", 4,
                 {"field 'weigth' is not there", "did you mean 'weight'?"});
  expect_failure("transfer painted.pvd head@wide=1 -o x --paint field:in_L", 4,
                 {"field 'in_L' lies on triangles"});
  expect_failure("transfer painted.pvd head@wide=1 -o x --paint field:displacement", 4,
                 {"field 'displacement'"});
  expect_failure("transfer painted.pvd head@wide=1 -o x --paint field:region", 3,
                 {"field 'region': vertex ", "expected 0 to 1"});
}

TEST_F(PaintTest, ShowsTheWeightsOnTheResult) {
  ASSERT_EQ(run(transfer("--paint w.csv --falloff 0.2")).code, 0);
  ASSERT_EQ(run("transfer head --weights take.csv head@wide=1 -o out.pvd --paint w.csv "
                "--regions-out regions.pvd")
                .code,
            0);
  for (const std::string shown : {"out.pvd", "regions.pvd"}) {
    const Json again =
        report("transfer " + shown + " head@wide=1 -o x.npy --force --paint field:weight");
    EXPECT_EQ(again["targets"][0]["weight"]["one"], 3 * kSide) << shown;
  }
}

TEST_F(PaintTest, GivesOneRowOfAnEvaluation) {
  const Json rows = report(evaluate("--paint w.csv"))["rows"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0]["k"].is_null());
  EXPECT_EQ(rows[0]["vertices"], 5 * kSide);
  EXPECT_EQ(rows[0]["triangles"], 5 * 2 * (kSide - 1));
  EXPECT_EQ(rows[1]["triangle_share"], 1);
}

TEST_F(PaintTest, OfOnesOnlyMovesEverything) {
  std::string ones;
  for (int v = 0; v < kSide * kSide; ++v) ones += "1\n";
  write("ones.txt", ones);
  const Json painted = report(transfer("--paint ones.txt"));
  EXPECT_EQ(painted["targets"][0]["weight"]["one"], kSide * kSide);
  EXPECT_EQ(painted["regions"]["triangle_share"], 1);
}

TEST_F(PaintTest, IsRefusedBesideWhatItReplaces) {
  write("r.txt", "3\n4\n");
  ASSERT_EQ(run("decompose head --weights take.csv -k 2 -o c.h5").code, 0);
  for (const std::string option :
       {"--full", "-k 2", "--coverage 0.5", "--select transfer", "--triangles 0.3", "--radius 0.2",
        "--only component:0", "--complete 0", "--regions r.txt", "--components c.h5"}) {
    const std::string name = option.substr(0, option.find(' '));
    expect_failure(transfer("--paint w.csv " + option), 2, {name + ": ", "--paint"});
  }
  for (const std::string option : {"-k 2", "--curve", "--select transfer"}) {
    const std::string name = option.substr(0, option.find(' '));
    expect_failure(evaluate("--paint w.csv " + option), 2, {name + ": ", "--paint"});
  }
  expect_failure(transfer("--paint w.csv --components-out d.h5"), 2,
                 {"--components-out", "--paint"});
  expect_failure(transfer("--paint w.csv --per-region"), 2, {"--per-region: ", "--paint"});
  expect_failure(evaluate("--paint w.csv --per-region"), 2, {"--per-region: ", "--paint"});
}

TEST_F(PaintTest, IsTakenAsItIsFromARegionSet) {
  ASSERT_EQ(run(transfer("--paint w.csv") + " --regions-out soft.json").code, 0);
  const std::string again =
      "transfer head --weights take.csv head@wide=1 -o out.npy --force --regions soft.json ";
  EXPECT_EQ(run(again).code, 0);
  for (const std::string option : {"--complete 0.5", "--complete-limit 0.2"}) {
    const std::string name = option.substr(0, option.find(' '));
    expect_failure(again + option, 2, {name + ": ", "soft.json", "taken as it is"});
  }
}

TEST_F(PaintTest, RegionsFadeOutByDefaultOnAMeshWithoutExpressions) {
  ASSERT_EQ(run("convert head@wide=1 -o wide.ply").code, 0);
  const std::string call = "transfer head --weights take.csv wide.ply -o out.npy --force -k 2 ";
  const Json by_default = report(call)["targets"][0], asked = report(call + "--falloff 0.2");
  EXPECT_EQ(by_default["weight"]["falloff"], "0.2");
  EXPECT_EQ(by_default["de_all"], asked["targets"][0]["de_all"]);
  for (const std::string option : {"--outside identity", "--triangles 0.9"}) {
    EXPECT_FALSE(report(call + option)["targets"][0].contains("weight")) << option;
  }
}

TEST_F(PaintTest, IsWhatAFalloffFadesOutAround) {
  const std::string hard =
      "transfer head --weights take.csv head@wide=1 -o out.npy --force -k 2 "
      "--complete 0 ";
  const Json without = report(hard), with = report(hard + "--falloff 0.2");
  EXPECT_FALSE(without["targets"][0].contains("weight"));
  EXPECT_GT(with["targets"][0]["weight"]["between"], 0);
  EXPECT_EQ(with["targets"][0]["weight"]["one"], without["regions"]["vertices"]);
  EXPECT_GT(with["regions"]["triangles"], without["regions"]["triangles"]);
  write("r.txt", "111\n112\n113\n");
  EXPECT_EQ(report("transfer head --weights take.csv head@wide=1 -o out.npy --force --complete 0 "
                   "--regions r.txt --falloff 0.2")["targets"][0]["weight"]["one"],
            3);
  std::string half;
  for (int v = 0; v < kSide * kSide; ++v) half += "0.5\n";
  write("half.txt", half);
  for (const std::string& call : {transfer(""), evaluate("")}) {
    expect_failure(call + "--paint half.txt --falloff 0.2", 4,
                   {"--falloff: half.txt: no vertex has the weight 1", "the largest is 0.5",
                    "give some vertices the weight 1"});
  }
  expect_failure(transfer("--full --falloff 0.2"), 2, {"--falloff: there are no regions"});
  expect_failure(evaluate("--curve --falloff 0.2"), 2, {"--falloff: --curve has rows at shares"});
}

TEST_F(PaintTest, HasNoSoftBorderWhereTrianglesOutsideKeepTheirShape) {
  ASSERT_EQ(run(transfer("--paint w.csv") + " --regions-out soft.json").code, 0);
  const std::vector<std::string> says = {"--outside: triangles that keep their shape hold nothing",
                                         "use --outside fixed"};
  const std::string outside = " --space vertex --outside identity";
  for (const std::string soft : {"--paint w.csv", "--falloff 0.2", "--regions soft.json"}) {
    expect_failure(transfer(soft + outside), 2, says);
  }
  for (const std::string soft : {"--paint w.csv", "--falloff 0.2"}) {
    expect_failure(evaluate(soft + outside), 2, says);
  }
  // A region's own weights fade in blendshape space only; there nothing is outside.
  EXPECT_EQ(run(transfer("--paint w.csv --outside identity")).code, 0);
}

TEST_F(PaintTest, SaysWhatMakesACreaseLessVisible) {
  // A region in the middle of a bump.
  write("r.txt", "48\n49\n63\n64\n");
  const std::string call =
      "transfer head --weights take.csv head@wide=1 -o out.npy --force --space vertex "
      "--complete 0 ";
  const auto says = [&](const std::string& options) {
    const test::CommandResult result = run(call + options);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(says("--regions r.txt"), HasSubstr("; --falloff 0.3 lets the motion fade"));
  EXPECT_THAT(says("--regions r.txt --falloff 0.01"), HasSubstr("; use a larger --falloff"));
  EXPECT_THAT(says("--regions r.txt --outside identity --outside-weight 10"),
              HasSubstr("; --falloff 0.3 without --outside identity lets the motion fade"));
  EXPECT_THAT(says("-k 2 --radius 0.1 --triangles 0.2"),
              HasSubstr("; --falloff 0.3 without --triangles lets the motion fade"));
}

TEST_F(PaintTest, IsToBeLargerWhereExpressionsAreHardlySeen) {
  write("few.csv", "vertex,weight\n48,1\n");
  const test::CommandResult result = run(transfer("--paint few.csv"));
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("; paint a wider border or more of the face, or use --full"));
  write("few.txt", "48\n");
  const test::CommandResult faded =
      run("transfer head --weights take.csv head@wide=1 -o out.npy --force --regions few.txt "
          "--complete 0 --falloff 0.01");
  EXPECT_EQ(faded.code, 0);
  EXPECT_THAT(faded.err, HasSubstr("; take a larger --falloff, more regions (-k, --radius) or "
                                   "--full instead"));
}

TEST_F(PaintTest, ReportsARunAsItWas) {
  ASSERT_EQ(run(transfer("--paint w.csv")).code, 0);
  const test::CommandResult report = run("report out.npy -o report.html");
  EXPECT_EQ(report.code, 0) << report.err;
  const test::CommandResult gallery = run("report out.npy -o r.html --gallery g.png");
  EXPECT_EQ(gallery.code, 4);
  EXPECT_THAT(gallery.err, HasSubstr("which have no components"));
}

}  // namespace
}  // namespace mimetra
