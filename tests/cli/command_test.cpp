#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/weight_file.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Command : public test::QuickCommandTest {};

TEST_F(Command, HelpListsTheCommandsOnStdout) {
  const auto result = run("--help");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("transfer"));
  EXPECT_EQ(result.err, "");
}

TEST_F(Command, HelpOfACommandEndsInTwoExamples) {
  const auto result = run("transfer --help");
  EXPECT_EQ(result.code, 0);
  const auto examples = result.out.substr(result.out.find("Examples:"));
  EXPECT_EQ(std::count(examples.begin(), examples.end(), '\n'), 4);
  EXPECT_THAT(examples, HasSubstr("mimetra transfer "));
  EXPECT_THAT(examples, HasSubstr("mimetra transfer --help all"));
}

TEST_F(Command, LongHelpExplainsWhatIsPrinted) {
  for (const auto& [name, measures] : std::map<std::string, std::vector<std::string>>{
           {"decompose", {"RMS error", "KG error", "displacements are zero"}},
           {"regions", {"motion energy"}},
           {"transfer", {"DE", "leak", "crease", "flipped"}},
           {"evaluate", {"DE", "MPE", "leak", "flipped"}}}) {
    const std::string help = run(name + " --help all").out;
    const auto prints = help.find("\nPrints:\n");
    ASSERT_NE(prints, std::string::npos) << name;
    for (const std::string& measure : measures) {
      EXPECT_THAT(help.substr(prints), HasSubstr("\n  " + measure)) << name;
    }
  }
}

TEST_F(Command, HelpOfEachFitsAScreenAndNamesAllOptionsThatItsLongHelpExplains) {
  const json table = json::parse(run("operations --json").out).at("operations");
  ASSERT_GT(table.size(), 20u);
  for (const json& operation : table) {
    const std::string name = operation.at("name");
    const auto brief = run(name + " --help"), all = run(name + " --help all");
    EXPECT_LE(std::count(brief.out.begin(), brief.out.end(), '\n'), 50) << name;
    std::istringstream lines(brief.out);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  mimetra ")) continue;  // examples and the synopsis
      EXPECT_LE(line.size(), 80u) << line;
    }
    const auto options = brief.out.substr(0, brief.out.find("Examples:"));
    for (const json& parameter : operation.value("parameters", json::array())) {
      const std::string parameter_name = parameter.at("name");
      const std::string option = (parameter_name.size() == 1 ? "-" : "--") + parameter_name;
      EXPECT_TRUE(std::regex_search(options, std::regex(" " + option + "[ \n]"))) << option;
      EXPECT_TRUE(std::regex_search(all.out, std::regex("\n  " + option + "[ \n]"))) << option;
    }
  }
}

TEST_F(Command, InfoCountsWhatTheSequenceHolds) {
  const auto result = run("info head --weights take.csv --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json info = json::parse(result.out);
  EXPECT_EQ(info.at("frames"), 12);
  EXPECT_EQ(info.at("vertices"), 15 * 15);
  EXPECT_EQ(info.at("triangles"), 2 * 14 * 14);
  EXPECT_EQ(info.at("components"), 1);
  EXPECT_EQ(info.at("boundary_edges"), 4 * 14);
  EXPECT_EQ(info.at("nonmanifold_edges"), 0);
  EXPECT_EQ(info.at("degenerate_triangles"), 0);
  EXPECT_EQ(info.at("welded_vertices"), 0);
  EXPECT_EQ(info.at("extent").size(), 3u);
  EXPECT_GT(info.at("motion").get<double>(), 0);
}

TEST_F(Command, InfoListsTheFieldsThatTheSequenceHas) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o rois.pvd").code, 0);
  const auto text = run("info rois.pvd");
  EXPECT_THAT(text.out, HasSubstr("\nfields      region, region_count, roi on vertices; in_L, "
                                  "region_color on faces\n"));
  const json fields = json::parse(run("info rois.pvd --json").out).at("fields");
  ASSERT_EQ(fields.size(), 5u);
  EXPECT_EQ(fields[0], json({{"name", "region"}, {"on", "vertices"}, {"numbers", 1}}));
  EXPECT_EQ(fields[4], json({{"name", "region_color"}, {"on", "faces"}, {"numbers", 3}}));

  EXPECT_THAT(run("info head --weights take.csv").out, Not(HasSubstr("fields")));
}

TEST_F(Command, FramesTakesAPartOfTheSequence) {
  const auto result = run("info head --weights take.csv --frames 2:10:4 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("frames"), 2);
}

TEST_F(Command, FramesReadsOnlyThoseOfALargeArray) {
  // 4.8 GB that the disk does not hold: all zeros.
  const test::Shape faces = test::grid(100, 100);
  write_mesh(folder_ / "large.topology.ply", test::mesh_of(faces));
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (20000, 10000, 3), }";
  header.append(117 - header.size(), ' ').append("\n");
  write("large.npy", std::string("\x93NUMPY\x01\0\x76\0", 10) + header);
  std::filesystem::resize_file(folder_ / "large.npy", 128 + 20000LL * 10000 * 3 * 8);
  const auto result = run("convert large.npy --frames 19990:20000 -o part.npy --dry-run --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json plan = json::parse(result.out);
  EXPECT_FALSE(plan.at("inputs").at(0).at("in_memory").get<bool>());
  EXPECT_LT(plan.at("memory_bytes").get<double>(), 1e9);
  ASSERT_EQ(run("convert large.npy --frames 19990:20000 -o part.npy").code, 0);
  EXPECT_EQ(read_npy_frames(folder_ / "part.npy"), Frames::Zero(10, 30000));
}

TEST_F(Command, ConvertsThroughEveryFormatOfOneFile) {
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
  EXPECT_THAT(listing(), testing::IsSupersetOf({"take.topology.ply", "take.rest.ply"}));
  const json info = json::parse(run("info take.npy --json").out);
  EXPECT_EQ(info.at("frames"), 12);
  EXPECT_EQ(info.at("rest_known"), true);
  const Frames frames = read_npy_frames(folder_ / "take.npy");
  std::string from = "take.npy";
  for (const std::string to : {"a.npz", "b.pc2", "c.mdd", "d.npy"}) {
    const auto result = run("convert " + from + " -o " + to);
    ASSERT_EQ(result.code, 0) << result.err;
    from = to;
  }
  EXPECT_EQ(read_npy_frames(folder_ / "d.npy"), frames.cast<float>().cast<double>());
  EXPECT_TRUE(listing().contains("b.topology.ply"));
  EXPECT_FALSE(listing().contains("a.topology.ply"));
}

TEST_F(Command, DecomposeWritesComponentsThatRegionsReads) {
  const auto result = run("decompose head --weights take.csv -k 3 -o c.h5 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("frames"), 12);
  EXPECT_EQ(report.at("components"), 3);
  EXPECT_FALSE(report.at("energies").empty());
  EXPECT_TRUE(report.at("converged").is_boolean());
  EXPECT_GE(report.at("iteration"), 1);
  EXPECT_LE(report.at("iteration"), report.at("energies").size());
  const auto regions = run("regions head --weights take.csv --components c.h5 -o r.json --json");
  ASSERT_EQ(regions.code, 0) << regions.err;
  const json found = json::parse(regions.out);
  EXPECT_EQ(found.at("regions").size(), 3u);
  EXPECT_EQ(found.at("converged"), report.at("converged"));
  EXPECT_GT(found.at("vertex_share").get<double>(), 0);
  EXPECT_LT(found.at("vertex_share").get<double>(), 1);
}

TEST_F(Command, DecomposeSaysInWordsThatItHasNotConverged) {
  const auto result = run("decompose head --weights take.csv -k 3 --iterations 2 -o c.h5");
  EXPECT_THAT(result.out + result.err, HasSubstr("2 iterations, not converged"));
}

TEST_F(Command, DecomposeAsTheReferenceRunsTenIterations) {
  const auto result =
      run("decompose head --weights take.csv -k 3 --compat splocs2013 -o c.h5 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("energies").size(), 10u);
  EXPECT_EQ(report.at("iteration"), 10);
}

TEST_F(Command, TransferLeavesItsComponentsForALaterRun) {
  const std::string transfer = "transfer head --weights take.csv head@wide=1 -k 3 ";
  ASSERT_EQ(run(transfer + "-o a.npy --components-out c.h5").code, 0);
  const auto result = run(transfer + "-o b.npy --components c.h5");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(text_of(folder_ / "a.npy"), text_of(folder_ / "b.npy"));
}

TEST_F(Command, RegionsWritesATimeSeriesForParaView) {
  const auto result = run("regions head --weights take.csv -k 3 -o out/r.pvd");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(text_of(folder_ / "out/r.pvd"), HasSubstr("r_vtp/r_0011.vtp"));
  const auto frames = listing("out/r_vtp");
  EXPECT_EQ(frames.size(), 12u + 1);
  EXPECT_TRUE(frames.contains("mimetra-run.json"));
}

TEST_F(Command, TransferToTheSameHeadGivesTheSourceBack) {
  const auto result =
      run("transfer head --weights take.csv head --full -o out.npy --weights-out w.csv --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("targets").size(), 1u);
  EXPECT_EQ(report.at("targets")[0].at("output"), "out.npy");
  EXPECT_LT(report.at("targets")[0].at("de_all").get<double>(), 1e-18);
  const WeightTrack found = read_weights(folder_ / "w.csv");
  // Exact up to rounding: the problem is consistent and well-conditioned.
  EXPECT_LT((found.weights - performance().weights).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Command, TransferWritesWeightsOfEachRegionThatRegionsOutNumbers) {
  const auto result = run(
      "transfer head --weights take.csv head@wide=1 head@wide=2 -k 3 --per-region -o out --json "
      "--weights-out w.csv --regions-out r.json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  const auto regions = report.at("regions").at("regions").size();
  for (const json& target : report.at("targets")) {
    EXPECT_EQ(target.at("per_region").at("regions"), regions);
    EXPECT_LT(target.at("per_region").at("violation").get<double>(), 1e-12);
    EXPECT_EQ(target.at("added_regions").size(), 0u);
  }
  const std::string name = performance().names.front();
  std::string header = text_of(folder_ / "w-head@wide=1.csv");
  header.resize(header.find('\n'));
  EXPECT_THAT(header, HasSubstr("time," + name + "@0,"));
  for (const std::string region : {"@0,", "@1,", "@background"}) {
    EXPECT_THAT(header, HasSubstr(region));
  }
  // One column each of the background and of every region.
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(header, '@')),
            (regions + 1) * performance().names.size());
}

TEST_F(Command, WeightsOfEachRegionHaveNoPlaceInLiveLink) {
  const auto result =
      run("transfer head --weights take.csv head@wide=1 -k 3 --per-region -o o/ --weights-out "
          "w.livelink.csv");
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("Live Link has one weight for each expression"));
}

TEST_F(Command, EvaluateMeasuresWeightsOfEachRegionBesideTheWholeFaces) {
  const auto result = run("evaluate head --weights take.csv head@wide=1 -k 3 --per-region --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json rows = json::parse(result.out).at("rows");
  EXPECT_LE(rows[0].at("de_all").get<double>(), rows[1].at("de_all").get<double>() * (1 + 1e-12));
}

TEST_F(Command, TransferTakesARegionSetFromAFile) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.json").code, 0);
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.vtp").code, 0);
  const std::string transfer = "transfer head --weights take.csv head@wide=1 --regions ";
  ASSERT_EQ(CommandTest::run(transfer + "r.json -o a.npy").code, 0);
  const auto result = CommandTest::run(transfer + "r.vtp -o b.npy");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(text_of(folder_ / "a.npy"), text_of(folder_ / "b.npy"));
}

TEST_F(Command, EvaluatePrintsOneRowPerCountAndTheFullTransfer) {
  const auto result =
      run("evaluate head --weights take.csv head@wide=1 -k 1,3 -o table.json --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json rows = json::parse(result.out).at("rows");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_TRUE(rows.back().at("k").is_null());
  EXPECT_EQ(json::parse(text_of(folder_ / "table.json")).at("rows").size(), 3u);
}

TEST_F(Command, AlignIsUndoneByItsManifest) {
  ASSERT_EQ(run("convert head --weights take.csv -o a.npy").code, 0);
  ASSERT_EQ(run("align a.npy --on all -o b.npy").code, 0);
  const auto result = run("align b.npy --undo b.run.json -o c.npy");
  ASSERT_EQ(result.code, 0) << result.err;
  const MeshSequence before = read_sequence((folder_ / "a.npy").string()).sequence;
  const MeshSequence after = read_sequence((folder_ / "c.npy").string()).sequence;
  EXPECT_LT((before.positions() - after.positions()).cwiseAbs().maxCoeff(), 1e-12 * 15);
}

TEST_F(Command, SaysWhereAMotionIsGivenBackInAnotherUnitOrAboutOtherAxes) {
  ASSERT_EQ(run("convert head --weights take.csv -o a.npy").code, 0);
  ASSERT_EQ(run("align a.npy --on all -o b.npy").code, 0);
  const auto undone = [&](const std::string& changed) {
    EXPECT_EQ(run("convert b.npy " + changed + " -o changed.npy --force").code, 0);
    const auto result = run("align changed.npy --undo b.run.json -o c.npy --force");
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(undone("--scale 0.01"), HasSubstr("100 times as small as the sequence that"));
  EXPECT_THAT(undone("--up y-to-z"), HasSubstr("has another axis up than the sequence"));
  for (const char* changed : {"", "--scale 1.9"}) {
    EXPECT_THAT(undone(changed), Not(HasSubstr("the sequence that the motion was taken out of")));
  }
}

TEST_F(Command, SaysWhereAMotionIsGivenBackToAFaceThatIsTurnedAndAsWideAsHigh) {
  ASSERT_EQ(run("convert head --weights take.csv -o a.npy").code, 0);
  MeshSequence take = read_sequence((folder_ / "a.npy").string()).sequence;
  const Eigen::RowVector3d extent =
      take.rest().colwise().maxCoeff() - take.rest().colwise().minCoeff();
  Frames poses = take.positions();
  for (Eigen::Index y = 1; y < poses.cols(); y += 3) poses.col(y) *= extent.z() / extent.y();
  write_sequence(take.with_frames(poses), folder_ / "even.npy");
  ASSERT_EQ(run("align even.npy --on all -o b.npy").code, 0);
  ASSERT_EQ(run("convert b.npy --up y-to-z -o changed.npy").code, 0);
  const std::string said = "has another axis up than the sequence";
  EXPECT_THAT(run("align changed.npy --undo b.run.json -o c.npy").err, HasSubstr(said));
  // Other vertices of the same head tell nothing of it.
  ASSERT_EQ(run("simplify b.npy --share 0.5 -o small.npy").code, 0);
  EXPECT_THAT(run("align small.npy --undo b.run.json -o d.npy").err, Not(HasSubstr(said)));
  std::vector<int> shuffled(static_cast<std::size_t>(take.vertices()));
  for (std::size_t v = 0; v < shuffled.size(); ++v) {
    shuffled[v] = static_cast<int>((v * 7919) % shuffled.size());
  }
  const MeshSequence still = read_sequence((folder_ / "b.npy").string()).sequence;
  Frames other(still.frames(), 3 * still.vertices());
  for (int v = 0; v < still.vertices(); ++v) {
    other.middleCols<3>(3 * v) =
        still.positions().middleCols<3>(3 * shuffled[static_cast<std::size_t>(v)]);
  }
  write_sequence(still.with_frames(other), folder_ / "other.npy");
  EXPECT_THAT(run("align other.npy --undo b.run.json -o e.npy").err, Not(HasSubstr(said)));
}

TEST_F(Command, SaysWherePositionsAreNumberedOtherwiseThanTheFacesThatTheyAreGiven) {
  ASSERT_EQ(run("convert head --weights take.csv -o a.npy").code, 0);
  const MeshSequence given = read_sequence((folder_ / "a.npy").string()).sequence;
  const int count = given.vertices();
  ASSERT_NE(count % 7, 0);
  Frames other(given.frames(), 3 * count);
  for (int v = 0; v < count; ++v) {
    other.middleCols<3>(3 * (v * 7 % count)) = given.positions().middleCols<3>(3 * v);
  }
  write_sequence(MeshSequence(given.shared_connectivity(), other), folder_ / "b.npy", {});
  const std::string odd = "of the edges are more than twice as long or as short as in";
  for (const auto& [line, is_odd] :
       {std::pair("check a.npy --topology head/neutral.ply --strict", false),
        std::pair("check b.npy --topology head/neutral.ply --strict", true),
        std::pair("convert b.npy --topology head/neutral.ply -o c.npy", true)}) {
    const auto result = run(line);
    EXPECT_EQ(result.err.find(odd) != std::string::npos, is_odd) << line << '\n' << result.err;
    if (!std::string(line).starts_with("check")) continue;
    EXPECT_EQ(result.code == 0, !is_odd) << line << '\n' << result.err;
  }
}

TEST_F(Command, SaysWhereComponentsAreWorseThanTheMeanFrame) {
  // Two frames that are alike, far from the neutral.
  write("near.csv", "time,left,right\n0,1,1\n1,1,0.99\n");
  EXPECT_THAT(run("decompose head --weights near.csv -k 1 -o near.h5").err,
              HasSubstr("times as much of the motion as the mean of the frames does"));
  // Frames that are all the same, and those that move.
  write("same.csv", "time,left,right\n0,1,1\n1,1,1\n");
  for (const char* weights : {"same.csv", "take.csv"}) {
    const std::string line = std::string("decompose head --weights ") + weights;
    EXPECT_THAT(run(line + " -k 1 -o other.h5 --force").err,
                Not(HasSubstr("as the mean of the frames does")));
  }
}

TEST_F(Command, SaysWhereAMotionIsGivenBackOrTakenOutTwice) {
  ASSERT_EQ(run("convert head --weights take.csv -o still.npy").code, 0);
  // Quarter turns around z.
  const int frames = read_sequence((folder_ / "still.npy").string()).sequence.frames();
  json motion = json::array();
  for (int f = 0; f < frames; ++f) {
    motion.push_back({{"rotation", {0, -1, 0, 1, 0, 0, 0, 0, 1}}, {"translation", {0, 3, f}}});
  }
  write("motion.json", json{{"result", {{"motion", motion}}}}.dump());
  const std::string undo = " --undo motion.json -o ";
  const std::string before = "before --undo gives a motion back";
  const auto once = run("align still.npy" + undo + "turned.npy");
  ASSERT_EQ(once.code, 0) << once.err;
  EXPECT_THAT(once.err, Not(HasSubstr(before)));
  EXPECT_THAT(run("align turned.npy" + undo + "twice.npy").err, HasSubstr(before));

  const std::string still = "was it taken out already";
  for (const auto& [name, twice] : {std::pair("turned.npy", false), std::pair("still.npy", true)}) {
    const auto result = run(std::string("transfer ") + name +
                            " head@wide=1 --align motion.json --full -o out.npy --force");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.find(still) != std::string::npos, twice) << name << '\n' << result.err;
  }
}

TEST_F(Command, OptionsCanComeFromAFile) {
  write("config.json", R"({"k": 2, "radius": "3abs"})");
  const auto result = run("regions head --weights take.csv --config config.json -o r.json --json");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("regions").size(), 2u);
}

TEST_F(Command, OperationsListsEveryCommand) {
  const json list = json::parse(run("operations --json").out)["operations"];
  std::set<std::string> names;
  for (const json& entry : list) names.insert(entry.at("name").get<std::string>());
  EXPECT_EQ(names, (std::set<std::string>{
                       "info",       "check",    "align",    "geodesic", "decompose",  "regions",
                       "transfer",   "evaluate", "rig",      "convert",  "retarget",   "markers",
                       "fit",        "render",   "report",   "sample",   "operations", "formats",
                       "completion", "manual",   "simplify", "subdivide"}));
}

TEST_F(Command, SampleIsAModelWithAPerformance) {
  ASSERT_EQ(run("sample -o sample").code, 0);
  const json info = json::parse(run("info sample --weights sample/performance.csv --json").out);
  EXPECT_EQ(info.at("frames"), 120);
}

TEST_F(Command, LoadsNoCodecsBeforeThereIsAVideo) {
  const auto libraries = run("--version", "LD_TRACE_LOADED_OBJECTS=1");
  ASSERT_EQ(libraries.code, 0);
  EXPECT_THAT(libraries.out, HasSubstr("libOpenMeshCore"));
  EXPECT_THAT(libraries.out, Not(HasSubstr("libavcodec")));
}

}  // namespace
}  // namespace mimetra
