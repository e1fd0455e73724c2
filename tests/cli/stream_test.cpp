#include <regex>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Runs that read their frames when they need them.
class Streamed : public test::QuickCommandTest {
 protected:
  static constexpr int kShort = 50, kLong = 500;
  static constexpr int kSide = 50;
  /// So much more the long take is.
  static constexpr double kMore = 8e-6 * (kLong - kShort) * 3 * kSide * kSide;

  void SetUp() override {
    CommandTest::SetUp();
    std::filesystem::create_directory(folder_ / "tmp");
  }

  /// A sheet that waves and turns, as NAME.npy; the same without motion, as sheet.ply; and half of
  /// it as rois.txt.
  void write_take(const std::string& name, int frames) const {
    const test::Shape sheet = test::grid(kSide, kSide);
    Frames poses = sheet.positions.reshaped<Eigen::RowMajor>().transpose().replicate(frames, 1);
    for (int f = 0; f < frames; ++f) {
      for (int v = 0; v < sheet.positions.rows(); ++v) {
        poses(f, 3 * v) += 0.01 * f;
        poses(f, 3 * v + 2) += std::sin(0.1 * f + 0.2 * sheet.positions(v, 0));
      }
    }
    write_npy_frames(folder_ / (name + ".npy"), poses);
    write_mesh(folder_ / (name + ".topology.ply"), test::mesh_of(sheet));
    write_mesh(folder_ / "sheet.ply", test::mesh_of(sheet));
    std::string inside;
    for (int v = 0; v < sheet.positions.rows() / 2; ++v) inside += std::to_string(v) + '\n';
    write("rois.txt", inside);
  }

  /// What a run says that it held at most, MB.
  double held(const std::string& arguments) const {
    // What the sanitizer keeps of freed memory counts as held, too.
    const auto result =
        run(arguments, "TMPDIR=tmp ASAN_OPTIONS=intercept_tls_get_addr=0:quarantine_size_mb=1");
    EXPECT_EQ(result.code, 0) << result.err;
    std::smatch found;
    if (!std::regex_search(result.err, found, std::regex("at most ([0-9]+) MB of memory"))) {
      ADD_FAILURE() << result.err;
      return 0;
    }
    return std::stod(found[1]);
  }

  void expect_the_same_memory(const std::string& before, const std::string& after) const {
    const double few = held(before + " short.npy " + after + " -o a.npy");
    const double many = held(before + " long.npy " + after + " -o b.npy");
    EXPECT_LT(many, few + kMore / 2);
    EXPECT_THAT(listing("tmp"), testing::IsEmpty());
  }
};

TEST_F(Streamed, AlignmentsHoldNoMoreForMoreFrames) {
  write_take("short", kShort);
  write_take("long", kLong);
  expect_the_same_memory("align --on all", "");
}

TEST_F(Streamed, TransfersByRegionsHoldNoMoreForMoreFrames) {
  write_take("short", kShort);
  write_take("long", kLong);
  expect_the_same_memory("transfer --align all --regions rois.txt", "sheet.ply");
}

TEST_F(Streamed, TransfersKeepFramesInAFolderThatThereMustBe) {
  write_take("long", kLong);
  const auto result =
      run("transfer long.npy sheet.ply --align none --full -o a.npy", "TMPDIR=missing");
  EXPECT_EQ(result.code, 5);
  EXPECT_THAT(result.err, testing::AllOf(HasSubstr("missing: cannot keep the numbers"),
                                         HasSubstr("set TMPDIR to a folder")));
  EXPECT_FALSE(listing().contains("a.npy"));
}

TEST_F(Streamed, DecompositionsKeepWithinTheMemoryAllowed) {
  write_take("long", kLong);
  const std::string decompose = "decompose long.npy --align none -k 2 --iterations 8 ";
  ASSERT_EQ(CommandTest::run(decompose + "-o a.h5").code, 0);
  const auto planned = [this](const std::string& arguments) {
    return json::parse(run(arguments + " --dry-run --json", "TMPDIR=tmp").out);
  };
  const double in_memory = planned(decompose + "-o b.h5").at("memory_bytes");
  // Too little for the frames, by more than what the program has differs from run to run.
  const double allowed = in_memory - 1e6 * kMore;
  const std::string bounded =
      decompose + "--memory " + std::to_string(std::llround(allowed)) + " -o b.h5";
  const json plan = planned(bounded);
  EXPECT_GT(plan.at("scratch_bytes").get<double>(), 1e6 * kMore);
  EXPECT_LT(plan.at("memory_bytes").get<double>(), in_memory - 0.5e6 * kMore);
  EXPECT_THAT(run(bounded + " --dry-run", "TMPDIR=tmp").out,
              HasSubstr("tmp (set TMPDIR for another folder), while it runs\n"));
  ASSERT_EQ(run(bounded, "TMPDIR=tmp").code, 0);
  EXPECT_EQ(read_file(folder_ / "a.h5"), read_file(folder_ / "b.h5"));
  EXPECT_THAT(listing("tmp"), testing::IsEmpty());
}

TEST_F(Streamed, PlansSayWhatIsReadAsAWhole) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.json").code, 0);
  const auto plan_of = [this](const std::string& arguments) {
    return json::parse(run(arguments + " --dry-run --json").out);
  };
  const auto reads_all = [&](const std::string& arguments) {
    return plan_of(arguments).at("inputs").at(0).at("in_memory").get<bool>();
  };
  const std::string transfer = "transfer head --weights take.csv head -o a.npy ";
  EXPECT_FALSE(reads_all(transfer));
  EXPECT_FALSE(reads_all(transfer + "--regions r.json"));
  EXPECT_FALSE(reads_all("decompose head --weights take.csv -k 2 -o c.h5"));
  EXPECT_FALSE(reads_all("regions head --weights take.csv -k 2 -o s.json"));
  EXPECT_FALSE(reads_all("align head --weights take.csv -o a.npy"));
  EXPECT_FALSE(reads_all("convert head --weights take.csv -o a.npy"));
  EXPECT_FALSE(reads_all("evaluate head --weights take.csv head -k 2"));
  EXPECT_FALSE(reads_all("render head --weights take.csv -o a.png"));
  EXPECT_TRUE(reads_all("geodesic head --weights take.csv --source 3 -o d.vtp"));
  EXPECT_THAT(run("geodesic head --weights take.csv --source 3 -o d.vtp --dry-run").out,
              HasSubstr("12 frames of 225 vertices, all in memory\n"));
}

TEST_F(Streamed, RegionsAreShownOnTheirSource) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.json").code, 0);
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o shown.pvd").code, 0);
  const auto result =
      run("transfer head --weights take.csv head --regions r.json -o a.npy "
          "--regions-out again.pvd");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(listing("again_vtp").size(), listing("shown_vtp").size());
}

TEST_F(Streamed, SeriesForParaViewKeepRestTimesAndFields) {
  const std::string take = "head --weights take.csv --frames 3:9 ";
  ASSERT_EQ(run("convert " + take + "-o take.npy").code, 0);
  ASSERT_EQ(run("convert " + take + "-o take.pvd").code, 0);
  const json info = json::parse(run("info take.pvd --json").out);
  EXPECT_EQ(info.at("rest_known"), true);
  EXPECT_EQ(info.at("frames"), 6);
  // In single precision, as positions are there.
  ASSERT_EQ(run("convert take.pvd -o back.npy").code, 0);
  const Positions rest = read_mesh(folder_ / "take.rest.ply").positions;
  const Positions back = read_mesh(folder_ / "back.rest.ply").positions;
  EXPECT_LT((back - rest).cwiseAbs().maxCoeff(), 1e-5 * rest.cwiseAbs().maxCoeff());

  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o shown.pvd").code, 0);
  for (const std::string operation : {"convert", "align"}) {
    const std::string out = operation + ".pvd";
    ASSERT_EQ(run(operation + " shown.pvd -o " + out).code, 0);
    const auto left_out = run("convert " + out + " -o " + operation + ".npy");
    EXPECT_THAT(left_out.err, HasSubstr("holds no fields; without region, region_count, roi"));
  }
}

TEST_F(Streamed, MeshesGiveTheBytesOfAnArray) {
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
  ASSERT_EQ(run("convert take.npy --double -o meshes").code, 0);
  for (const std::string arguments :
       {"align %", "transfer % head --full --align stable",
        "transfer % head --full --align all --space vertex --head-motion drop"}) {
    for (const std::string source : {"take.npy", "meshes"}) {
      const std::string line = std::string(arguments).replace(arguments.find('%'), 1, source);
      const auto result = run(line + " --force -o of_" + source + ".npy");
      ASSERT_EQ(result.code, 0) << result.err;
    }
    EXPECT_EQ(text_of(folder_ / "of_take.npy.npy"), text_of(folder_ / "of_meshes.npy"))
        << arguments;
  }
}

}  // namespace
}  // namespace mimetra
