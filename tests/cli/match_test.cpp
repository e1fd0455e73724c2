#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/matched_patch.h"
#include "tests/cli/run_here.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/mesh_file.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

/// A performance of the model, and a mesh of other faces.
class MatchTest : public test::QuickCommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("small.obj", test::small_patch());
    write("m.txt", test::patch_markers(0));
  }

  nlohmann::json report_of(const std::string& arguments) const {
    const auto result = run(arguments + " --json");
    EXPECT_EQ(result.code, 0) << arguments << '\n' << result.err;
    return nlohmann::json::parse(result.out);
  }

  static constexpr const char* kSource = "transfer head --weights take.csv ";
};

TEST_F(MatchTest, WritesTheCorrespondenceThatAnotherRunTakes) {
  const auto report = report_of(std::string(kSource) + "small.obj --full --markers m.txt -o x.npy");
  EXPECT_EQ(report["targets"][0]["correspondence"]["verdict"], "good");
  EXPECT_EQ(report["targets"][0]["correspondence"]["markers"], 9);
  ASSERT_TRUE(listing().contains("x.correspondence.json"));
  report_of(std::string(kSource) +
            "small.obj --full --correspondence x.correspondence.json -o y.npy");
  EXPECT_EQ(text_of(folder_ / "y.npy"), text_of(folder_ / "x.npy"));
  EXPECT_EQ(text_of(folder_ / "y.correspondence.json"), text_of(folder_ / "x.correspondence.json"));
}

TEST_F(MatchTest, LeavesACorrespondenceThatItDidNotWrite) {
  for (const std::string out : {"x.npy", "x.glb", "x.pvd"}) {
    write("x.correspondence.json", "mine");
    const auto result = run(std::string(kSource) + "small.obj --full --markers m.txt -o " + out);
    EXPECT_EQ(result.code, 5) << out;
    EXPECT_THAT(result.err, HasSubstr("x.correspondence.json"));
    EXPECT_EQ(text_of(folder_ / "x.correspondence.json"), "mine");
    EXPECT_FALSE(listing().contains(out));
  }
}

TEST_F(MatchTest, ReplacesItsOwnCorrespondenceWithItsOutput) {
  const std::string base = std::string(kSource) + "small.obj --full -o x.npy --markers ";
  report_of(base + "m.txt");
  const std::string markers = test::patch_markers(0);
  write("few.txt", markers.substr(0, markers.rfind('\n', markers.size() - 2) + 1));
  EXPECT_EQ(run(base + "few.txt").code, 5);
  const std::string before = text_of(folder_ / "x.correspondence.json");
  report_of(base + "few.txt --force");
  EXPECT_NE(text_of(folder_ / "x.correspondence.json"), before);
}

TEST_F(MatchTest, NeedsNoMarkersForTheSourcesFaces) {
  const std::string wide = std::string(kSource) + "head@wide=1 --full ";
  report_of(wide + "-o x.npy");
  const auto result = run(wide + "--markers m.txt -o y.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("head@wide=1: has the source's faces"));
  EXPECT_EQ(text_of(folder_ / "y.npy"), text_of(folder_ / "x.npy"));
}

TEST_F(MatchTest, ShowsTheResidualsWhereFieldsAreWritten) {
  report_of(std::string(kSource) + "small.obj --full --markers m.txt -o x.pvd");
  const std::string first = text_of(folder_ / "x_vtp/x_0000.vtp");
  EXPECT_THAT(first, HasSubstr("\"match_residual\""));
  EXPECT_THAT(first, HasSubstr("\"match_partners\""));
}

TEST_F(MatchTest, TakesAFileForEachTargetOrOneForAll) {
  write("other.obj", test::small_patch());
  const std::string both = std::string(kSource) + "small.obj other.obj -k 2 -o out/ ";
  const auto one = report_of(both + "--markers m.txt");
  const auto each = report_of(both + "--markers m.txt,m.txt --force");
  for (int t = 0; t < 2; ++t) {
    EXPECT_EQ(each["targets"][t]["de_all"], one["targets"][t]["de_all"]);
    EXPECT_GE(one["targets"][t]["correspondence"]["seconds"], 0);
    EXPECT_GE(one["targets"][t]["error_seconds"], 0);
  }
  EXPECT_TRUE(listing("out/other").contains("correspondence.json"));
}

TEST_F(MatchTest, NamesTheLinesOfExchangedMarkers) {
  // Lines 2 and 4 have each other's target.
  std::string markers = test::patch_markers(0);
  const auto replace = [&markers](const std::string& old, const std::string& by) {
    markers.replace(markers.find(old), old.size(), by);
  };
  replace("6 3\n", "6 24!\n");
  replace("90 24\n", "90 3\n");
  replace("!", "");
  write("exchanged.txt", markers);
  const auto result =
      run(std::string(kSource) + "small.obj --full --markers exchanged.txt -o x.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("exchanged.txt, line 2 (vertices 6 and 24) and exchanged.txt, "
                                    "line 4 (vertices 90 and 3) are likely exchanged"));
}

TEST_F(MatchTest, ForeseesInADryRunWhatMarkersAreRefusedFor) {
  write("wrong.txt", test::patch_markers(1));
  for (const std::string command : {"transfer head --weights take.csv small.obj --full -o x.npy ",
                                    "evaluate head --weights take.csv small.obj -k 2 "}) {
    const auto wrong = run(command + "--markers wrong.txt --dry-run");
    EXPECT_EQ(wrong.code, 4) << command;
    EXPECT_THAT(wrong.err, HasSubstr("--index-base 1"));
    const auto right = run(command + "--markers m.txt --dry-run");
    EXPECT_EQ(right.code, 0) << right.err;
  }
  EXPECT_FALSE(listing().contains("x.npy"));
}

TEST_F(MatchTest, ForeseesInADryRunFilesThatAreNobodys) {
  write("x.correspondence.json", "mine");
  write("x.rest.ply", "mine");
  const auto planned =
      run(std::string(kSource) + "small.obj --full --markers m.txt -o x.npy --dry-run");
  EXPECT_EQ(planned.code, 0);
  EXPECT_THAT(planned.err, HasSubstr("x.correspondence.json: stands without 'x.npy'"));
  EXPECT_THAT(planned.err, HasSubstr("x.rest.ply: stands without 'x.npy'"));
}

TEST_F(MatchTest, TakesSeveralMarkerFilesFromAConfiguration) {
  write("other.obj", test::small_patch());
  write("config.json", R"({"markers": ["m.txt", "m.txt"], "full": true})");
  report_of(std::string(kSource) + "small.obj other.obj --config config.json -o out/");
  EXPECT_TRUE(listing("out").contains("other"));
}

TEST_F(MatchTest, IdentityAsAFileGivesTheSameVertices) {
  const MorphableModel head = model();
  const Connectivity& faces = head.connectivity();
  write("same.json",
        correspondence_json(Correspondence::identity(static_cast<int>(faces.triangles.rows())),
                            faces, faces));
  const std::string wide = std::string(kSource) + "head@wide=1 --space vertex -k 2 ";
  report_of(wide + "-o x.npy");
  report_of(wide + "--correspondence same.json -o y.npy");
  EXPECT_EQ(text_of(folder_ / "y.npy"), text_of(folder_ / "x.npy"));
}

TEST_F(MatchTest, EvaluatesOverACorrespondence) {
  const auto report = report_of("evaluate head --weights take.csv small.obj -k 2 --markers m.txt");
  ASSERT_EQ(report["rows"].size(), 2u);
  EXPECT_EQ(report["rows"][1]["vertices"], 225);
}

TEST_F(MatchTest, ConvertKeepsAModelsExpressions) {
  // The neutral with its vertices numbered backwards.
  const MorphableModel head = model();
  const int last = head.vertices() - 1;
  const Positions backwards = head.mean().colwise().reverse();
  write_mesh(
      folder_ / "back.ply",
      TriMesh{backwards, Connectivity::from_triangles(
                             last + 1, Triangles(last - head.connectivity().triangles.array()))});
  ASSERT_EQ(run("convert head --match back.ply -o back.glb").code, 0);
  const BlendshapeModel found = read_blendshapes((folder_ / "back.glb").string());
  EXPECT_EQ(found.expressions().names, head.expressions().names);
  EXPECT_LT((found.neutral() - backwards).cwiseAbs().maxCoeff(), 1e-5);
  for (int j = 0; j < found.expressions().size(); ++j) {
    const Eigen::VectorXd one = found.expressions().displacements.col(j),
                          other = head.expressions().displacements.col(j);
    const Eigen::Map<const Positions> turned(other.data(), last + 1, 3);
    EXPECT_LT((Eigen::Map<const Positions>(one.data(), last + 1, 3) - turned.colwise().reverse())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-5)
        << j;
  }
}

TEST_F(MatchTest, ConvertSaysWhereAModelsExpressionsAreLost) {
  EXPECT_THAT(run("convert head -o frames/").err, HasSubstr("not the 3 expressions of the model"));
  for (const char* output : {"m.glb", "m.ply"}) {
    EXPECT_THAT(run("convert head -o " + std::string(output)).err,
                testing::Not(HasSubstr("expressions of the model")))
        << output;
  }
}

TEST_F(MatchTest, WhatChangesAModelsMeshSaysThatItsExpressionsAreLost) {
  for (const char* line : {"simplify head --share 0.9 -o small.glb", "subdivide head -o fine.glb",
                           "align head -o still.npy"}) {
    const auto result = run(line);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("holds the neutral alone, not the 3 expressions")) << line;
  }
}

}  // namespace
}  // namespace mimetra
