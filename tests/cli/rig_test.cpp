// A rig of the built-in head: another of its people, whose true expressions are known.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "samples/head/head.h"
#include "tests/cli/matched_patch.h"
#include "tests/cli/run_here.h"
#include "toolkit/io/mesh_file.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

class RigCommand : public test::QuickCommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    ASSERT_EQ(run("sample -o sample").code, 0);
    const MorphableModel sample = samples::parametric_head();
    truth_ = sample.person(Eigen::VectorXd::Unit(sample.identities().size(), 2));
    save("double.ply", truth_.neutral());
    std::filesystem::create_directory(folder_ / "scans");
  }

  void save(const std::string& name, const Positions& positions) const {
    write_mesh(folder_ / name, PositionsView(positions.data(), positions.rows(), 3),
               truth_.connectivity(), {.double_precision = true});
  }
  void save_example(const std::string& name) const {
    const int index = truth_.expressions().find(name);
    save("scans/" + name + ".ply",
         truth_.pose(Eigen::VectorXd::Unit(truth_.expressions().size(), index)));
  }

  nlohmann::json rig(const std::string& arguments) const {
    const auto result = run("rig sample double.ply " + arguments + " --json --force");
    EXPECT_EQ(result.code, 0) << arguments << '\n' << result.err;
    return result.code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json();
  }

  /// Distances of vertices from where they are in the true expressions, of the diagonal: the mean
  /// over all expressions but `without`.
  double error_of(const std::string& model, const std::vector<std::string>& without = {}) const {
    const BlendshapeModel made = read_blendshapes(folder_ / model);
    double sum = 0;
    int count = 0;
    for (int j = 0; j < truth_.expressions().size(); ++j) {
      const std::string& name = truth_.expressions().names[static_cast<std::size_t>(j)];
      if (std::ranges::find(without, name) != without.end()) continue;
      const int found = made.expressions().find(name);
      EXPECT_GE(found, 0) << name;
      const Eigen::VectorXd difference =
          made.expressions().displacements.col(found) - truth_.expressions().displacements.col(j);
      sum += Eigen::Map<const Positions>(difference.data(), truth_.vertices(), 3)
                 .rowwise()
                 .norm()
                 .mean();
      ++count;
    }
    return sum / count / box_diagonal(truth_.neutral());
  }

  BlendshapeModel truth_;
};

const std::vector<std::string> kGiven = {"jawOpen", "mouthSmileLeft", "mouthSmileRight"};

TEST_F(RigCommand, KeepsThreeTrueExamplesAndIsNearerToTheTruthWithThemThanWithout) {
  const auto before = listing();
  const auto planned = run("rig sample double.ply -o none --dry-run");
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ(listing(), before);
  const auto report = rig("-o none");
  EXPECT_EQ(report["expressions"].size(), 12u);
  for (const auto& each : report["expressions"]) EXPECT_EQ(each["origin"], "transferred");
  for (const std::string& name : kGiven) save_example(name);
  const auto of_three = rig("--examples scans -o three");
  EXPECT_EQ(of_three["examples"].size(), 3u);
  // A thousandth of the diagonal is what plain transfers to other faces miss by.
  EXPECT_LT(error_of("none"), 1e-3);
  EXPECT_LT(error_of("three"), error_of("none"));
  EXPECT_LT(error_of("three", kGiven), error_of("none", kGiven));
  for (const auto& each : of_three["expressions"]) {
    const bool is_given =
        std::ranges::find(kGiven, each["name"].get<std::string>()) != kGiven.end();
    EXPECT_EQ(each["origin"] == "example", is_given) << each;
  }
  const BlendshapeModel made = read_blendshapes(folder_ / "three");
  for (const std::string& name : kGiven) {
    const Eigen::VectorXd difference =
        made.expressions().displacements.col(made.expressions().find(name)) -
        truth_.expressions().displacements.col(truth_.expressions().find(name));
    // Doubles in millimetres go through a file.
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_F(RigCommand, LearnsFromPosesOfGivenAndOfUnknownWeights) {
  const auto weights_of = [this](const std::string& one, const std::string& other) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(truth_.expressions().size());
    weights[truth_.expressions().find(one)] = 1;
    weights[truth_.expressions().find(other)] = 0.5;
    return weights;
  };
  save("scans/talk.ply", truth_.pose(weights_of("jawOpen", "mouthSmileLeft")));
  save("scans/laugh.ply", truth_.pose(weights_of("mouthSmileRight", "jawOpen")));
  const auto open = rig("--examples scans --estimate-weights -o unknown");
  EXPECT_TRUE(open["examples"][1]["estimated"]);
  // The transferred expressions are near enough to the true ones to know them by.
  EXPECT_NEAR(open["examples"][1]["weights"]["jawOpen"].get<double>(), 1, 0.1);
  write("scans/examples.csv",
        "mesh,jawOpen,mouthSmileLeft,mouthSmileRight\ntalk,1,0.5,0\nlaugh,0.5,0,1\n");
  const auto given = rig("--examples scans -o given");
  EXPECT_FALSE(given["examples"][1]["estimated"]);
  rig("-o none");
  EXPECT_LT(error_of("given"), error_of("none"));
  EXPECT_LT(error_of("unknown"), error_of("none"));
}

TEST_F(RigCommand, WritesAModelThatDrivesAndSaysWhatItDidInItsManifest) {
  const auto report = rig("-o double.glb");
  EXPECT_LT(report["missed"].get<double>(), 0.08);
  EXPECT_EQ(run("info double.glb --weights sample/performance.csv --json").code, 0);
  EXPECT_THAT(text_of(folder_ / "double.glb.run.json") + text_of(folder_ / "double.run.json"),
              HasSubstr("\"rig\""));
}

TEST_F(RigCommand, TakesATargetOfOtherFaces) {
  write("small.obj", test::small_patch());
  write("m.txt", test::patch_markers(0));
  const auto result = run("rig head small.obj --markers m.txt -o out --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["correspondence"]["markers"], 9);
  for (const auto& each : report["expressions"]) {
    EXPECT_GT(each["largest_displacement"].get<double>(), 0.5);
  }
  for (const std::string out : {"again", "again.glb"}) {
    const auto again = run("rig head small.obj --correspondence out/correspondence.json -o " + out);
    EXPECT_EQ(again.code, 0) << again.err;
  }
  EXPECT_EQ(text_of(folder_ / "again/expressions/top.ply"),
            text_of(folder_ / "out/expressions/top.ply"));
  EXPECT_EQ(text_of(folder_ / "again.correspondence.json"),
            text_of(folder_ / "out/correspondence.json"));
  write("x.correspondence.json", "mine");
  EXPECT_THAT(run("rig head small.obj --markers m.txt -o x.glb --dry-run").err,
              HasSubstr("x.correspondence.json: stands without 'x.glb'"));
}

}  // namespace
}  // namespace mimetra
