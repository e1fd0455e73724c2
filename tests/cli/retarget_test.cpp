#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/matched_patch.h"
#include "tests/cli/run_here.h"
#include "toolkit/io/mesh_file.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A model, its weights, and another identity of it.
class RetargetCommand : public test::QuickCommandTest {
 protected:
  test::CommandResult done(const std::string& arguments) const {
    test::CommandResult result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << '\n' << result.err;
    return result;
  }
  nlohmann::json report_of(const std::string& arguments) const {
    return nlohmann::json::parse(done(arguments + " --json").out);
  }
  WeightTrack weights(const std::string& name) const { return read_weights(folder_ / name); }

  static constexpr const char* kRigs = "retarget head head@wide=1 --weights take.csv ";
};

TEST_F(RetargetCommand, GivesARigItsOwnWeights) {
  const auto report = report_of("retarget head head --weights take.csv -o w.csv");
  const WeightTrack found = weights("w.csv"), given = performance();
  EXPECT_EQ(found.names, given.names);
  EXPECT_EQ(found.times, given.times);
  // Weights within the box, of three bumps that hardly overlap.
  EXPECT_LE((found.weights - given.weights).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(report["matched"], nlohmann::json({"left", "right", "top"}));
  EXPECT_EQ(report["shared"]["names"], 3);
  EXPECT_LE(report["shared"]["largest"], 1e-9);
  EXPECT_EQ(report["frames"], 12);
}

TEST_F(RetargetCommand, KeepsAMapThatDoesWithoutMeshes) {
  const auto report =
      report_of(std::string(kRigs) + "-o w.csv --map-out map.json --matrix-out matrix.csv");
  done("retarget --map map.json --weights take.csv -o by_map.csv");
  const double largest =
      (weights("by_map.csv").weights - weights("w.csv").weights).cwiseAbs().maxCoeff();
  EXPECT_NEAR(report["map"]["largest"], largest, 1e-12);
  EXPECT_LE(largest, 0.05);
  EXPECT_TRUE(text_of(folder_ / "matrix.csv").starts_with("expression,left,right,top\nleft,"));
  EXPECT_LE(report["matrix"]["clipped"]["rms"], report["matrix"]["unbounded"]["rms"]);
}

TEST_F(RetargetCommand, StatesTheErrorOfAMatrix) {
  EXPECT_THAT(done(std::string(kRigs) + "-o w.csv --matrix-out m.csv").err,
              HasSubstr("the matrix knows no bounds: its weights differ from these by"));
}

TEST_F(RetargetCommand, SaysWhatAMapDoesNotKeep) {
  EXPECT_THAT(done(std::string(kRigs) + "--ridge 0.1 --smoothness 0.1 -o w.csv --map-out m.json "
                                        "--matrix-out m.csv")
                  .err,
              AllOf(HasSubstr("the map does not keep --ridge and --smoothness; give them with "
                              "--map too"),
                    HasSubstr("the matrix does not keep --ridge and --smoothness")));
  EXPECT_THAT(done(std::string(kRigs) + "-o v.csv --map-out n.json").err,
              Not(HasSubstr("does not keep")));
  // Given again they count.
  done("retarget --map m.json --weights take.csv -o plain.csv");
  done("retarget --map m.json --weights take.csv --ridge 0.1 --smoothness 0.1 -o eased.csv");
  EXPECT_LE((weights("eased.csv").weights - weights("w.csv").weights).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_GT((weights("plain.csv").weights - weights("w.csv").weights).cwiseAbs().maxCoeff(), 0.05);
}

TEST_F(RetargetCommand, MakesNoMapThatWouldDropTheTargetsRules) {
  write("r.json", R"({"expressions": {"left": {"maximum": 0.5}}})");
  const std::string rules = std::string(kRigs) + "--rules r.json -o w.csv ";
  for (const std::string kept : {"--map-out", "--matrix-out"}) {
    const test::CommandResult result = run(rules + kept + " m.csv");
    EXPECT_NE(result.code, 0);
    EXPECT_FALSE(listing().contains("w.csv"));
  }
  EXPECT_THAT(run(rules + "--map-out m.json").err, HasSubstr("leave them out by --rules none"));
  done(rules);
  EXPECT_LE(weights("w.csv").weights.col(0).maxCoeff(), 0.5);
  done(std::string(kRigs) + "--rules none -o w.csv --map-out m.json --force");
}

TEST_F(RetargetCommand, ForeseesInADryRunWhatItRefuses) {
  write("r.json", R"({"expressions": {"left": {"maximum": 0.5}}})");
  const std::string refused[] = {"--rules r.json --map-out m.json", "--rules no.json",
                                 "--exclusive eyes", "--symmetry 1"};
  for (const std::string& options : refused) {
    const auto planned = run(std::string(kRigs) + "-o w.csv --dry-run " + options);
    const auto made = run(std::string(kRigs) + "-o w.csv " + options);
    EXPECT_NE(made.code, 0) << options;
    EXPECT_EQ(planned.code, made.code) << options;
    EXPECT_EQ(planned.err, made.err) << options;
  }
  EXPECT_EQ(done(std::string(kRigs) + "-o w.csv --dry-run --rules r.json").code, 0);
  EXPECT_FALSE(listing().contains("w.csv"));
}

TEST_F(RetargetCommand, EasesWeightsWithinTheBoundsOfAMap) {
  done(std::string(kRigs) + "-o w.csv --map-out map.json");
  std::string map = text_of(folder_ / "map.json");
  const std::size_t upper = map.find('1', map.find("\"upper\""));
  map.replace(upper, map.find_first_of(",\n]", upper) - upper, "0.25");
  write("low.json", map);
  done("retarget --map low.json --weights take.csv --smoothness 0.01 -o eased.csv");
  EXPECT_EQ(weights("eased.csv").weights.col(0).maxCoeff(), 0.25);
  const std::size_t lower = map.find('0', map.find("\"lower\""));
  map.replace(lower, map.find_first_of(",\n]", lower) - lower, "-0.5");
  write("negative.json", map);
  for (const std::string mode : {"", " --dry-run"}) {
    const auto result =
        run("retarget --map negative.json --weights take.csv --l1 0.1 -o x.csv" + mode);
    EXPECT_EQ(result.code, 4) << mode;
    EXPECT_THAT(result.err, HasSubstr("negative.json: 'left' may be negative")) << mode;
  }
}

TEST_F(RetargetCommand, TakesAMapFromOneTopologyToAnother) {
  // The target of a quarter of the faces has the bumps of the model at its own vertices.
  const BlendshapeModel fine = model().average();
  write("quarter.obj", test::small_patch());
  const TriMesh coarse = read_mesh(folder_ / "quarter.obj");
  ShapeBasis shapes{fine.expressions().names, Eigen::MatrixXd(3 * 64, 3)};
  for (int v = 0; v < 64; ++v) {
    const int of_fine = 30 * (v / 8) + 2 * (v % 8);
    shapes.displacements.middleRows(3 * v, 3) =
        fine.expressions().displacements.middleRows(3 * of_fine, 3);
  }
  write_model(folder_ / "small", MorphableModel(std::make_shared<Connectivity>(coarse.connectivity),
                                                coarse.positions, {}, shapes));
  write("m.txt", test::patch_markers(0));
  const auto report = report_of(
      "retarget head small --weights take.csv --markers m.txt -o w.csv --map-out map.json");
  EXPECT_EQ(report["correspondence"]["verdict"], "good");
  // Bumps of three edges' radius are cut off by the coarse faces, and by the pairs' means.
  EXPECT_LE(report["shared"]["mean"], 0.1);
  EXPECT_LE(report["map"]["largest"], 0.1);
  done("retarget head small --weights take.csv --correspondence w.correspondence.json -o v.csv");
  EXPECT_EQ(text_of(folder_ / "v.csv"), text_of(folder_ / "w.csv"));
}

TEST_F(RetargetCommand, TakesFramesAndARate) {
  write("plain.csv", "left,right,top\n0,0,0\n0.5,0,0\n0,0.5,0\n0,0,0.5\n");
  done("retarget head head --weights plain.csv --frames 1:4:2 --fps 10 -o w.csv");
  const WeightTrack found = weights("w.csv");
  EXPECT_EQ(found.times, Eigen::Vector2d(0.1, 0.3));
  EXPECT_NEAR(found.weights(0, 0), 0.5, 1e-9);
  EXPECT_NEAR(found.weights(1, 2), 0.5, 1e-9);
  done("retarget head head --weights plain.csv -o v.csv");
  EXPECT_EQ(weights("v.csv").times.size(), 0);
}

TEST_F(RetargetCommand, SaysWhichNamesAreNotUsedAndWhatStays0) {
  write("part.csv", "time,left,smile\n0,0,0\n1,0.5,1\n");
  const auto result = done("retarget head head --weights part.csv -o w.csv");
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("part.csv: columns that drive no expression of the source: smile"),
                    HasSubstr("expressions of the source that no column drives: right, top"),
                    HasSubstr("expressions of the target that stay 0 in all frames: right, top")));
}

/// Weights that a model drives, written.
class ConvertWeights : public RetargetCommand {
 protected:
  /// A model whose expressions are ARKit's.
  void write_arkit() const {
    const MorphableModel head = model();
    ShapeBasis shapes = head.average().expressions();
    shapes.names = {"mouthSmile_L", "jawOpen", "browInnerUp"};
    write_model(folder_ / "arkit", MorphableModel(head.average().shared_connectivity(),
                                                  head.average().neutral(), {}, shapes));
    WeightTrack track = performance();
    track.names = {"mouthSmileLeft", "jawOpen", "browInnerUp"};
    track.times = Eigen::VectorXd::LinSpaced(12, 0, 1.1);
    write_weights(folder_ / "talk.csv", track, false);
  }
};

TEST_F(ConvertWeights, KeepsThemInEveryForm) {
  write_arkit();
  done("convert arkit --weights talk.csv -o a.json");
  done("convert arkit --weights a.json -o b.csv");
  const auto result = done("convert arkit --weights b.csv -o c.livelink.csv");
  EXPECT_THAT(result.err, Not(HasSubstr("times")));
  done("convert arkit --weights c.livelink.csv -o d.csv");
  const WeightTrack given = weights("talk.csv");
  for (const std::string name : {"a.json", "b.csv", "d.csv"}) {
    const WeightTrack found = weights(name);
    EXPECT_EQ(found.weights, weights_for(given, found.names)) << name;
    EXPECT_LE((found.times - given.times).cwiseAbs().maxCoeff(), 1e-4) << name;
  }
  EXPECT_THAT(text_of(folder_ / "c.livelink.csv"), HasSubstr(",MouthSmileLeft,"));
}

TEST_F(ConvertWeights, SaysWhatLiveLinkLoses) {
  write_arkit();
  EXPECT_THAT(done("convert arkit --weights talk.csv --frames 3:6 -o c.livelink.csv").err,
              AllOf(HasSubstr("c.livelink.csv: the weights begin at 0.3 s"),
                    HasSubstr("no second ends among its timecodes")));
}

TEST_F(ConvertWeights, RefusesWhatWouldBeIgnored) {
  for (const std::string option : {"--scale 2", "--up y-to-z", "--match head"}) {
    const auto result = run("convert head --weights take.csv -o w.csv " + option);
    EXPECT_EQ(result.code, 2) << option;
    EXPECT_THAT(result.err, AllOf(HasSubstr(option.substr(0, option.find(' '))),
                                  HasSubstr("w.csv holds weights")));
  }
  done("convert head --weights take.csv -o take.npy");
  const auto bare = run("convert take.npy -o w.csv");
  EXPECT_EQ(bare.code, 2);
  EXPECT_THAT(bare.err, HasSubstr("w.csv: holds weights, and none drive the sequence"));
  EXPECT_FALSE(listing().contains("w.csv"));
}

TEST_F(ConvertWeights, RefusesLiveLinkBeforeTheWorkWhereItHoldsNothing) {
  const std::string transfer = "transfer head --weights take.csv head --full -o x.npy ";
  for (const std::string& line :
       {std::string("convert head --weights take.csv -o w.livelink.csv"),
        transfer + "--weights-out w.livelink.csv",
        std::string("retarget head head --weights take.csv -o w.livelink.csv"),
        std::string("decompose head --weights take.csv -k 2 -o c.h5 --weights-out w.livelink.csv"),
        std::string("evaluate head --weights take.csv head -k 2 -o w.livelink.csv"),
        std::string("align head --weights take.csv -o w.livelink.csv")}) {
    const auto before = listing();
    const auto result = run(line);
    EXPECT_EQ(result.code, 2) << line << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr("w.livelink.csv")) << line;
    EXPECT_EQ(listing(), before) << line;
  }
}

TEST_F(ConvertWeights, OfSeveralTargetsKeepTheirWholeEnding) {
  write_arkit();
  done("convert arkit --weights talk.csv -o arkit2.glb");
  done(
      "transfer arkit --weights talk.csv arkit arkit2.glb --full -o out/ --weights-out "
      "w.livelink.csv");
  EXPECT_TRUE(listing().contains("w-arkit.livelink.csv"));
  EXPECT_TRUE(listing().contains("w-arkit2.livelink.csv"));
  EXPECT_THAT(text_of(folder_ / "w-arkit.livelink.csv"), HasSubstr("BlendShapeCount"));
}

}  // namespace
}  // namespace mimetra
