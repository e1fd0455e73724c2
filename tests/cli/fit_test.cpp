#include <numbers>

#include <gmock/gmock.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"
#include "tests/fitting/synthetic_clip.h"
#include "toolkit/io/fit_file.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kFrames = 6;

class Fit : public test::QuickCommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    clip_ = test::synthetic_clip(7, {.frames = kFrames, .noise = 0.5});
    write_model(folder_ / "face", clip_.model);
    std::string mapping;
    for (const int vertex : clip_.vertices) mapping += std::to_string(vertex) + '\n';
    write("face/landmarks68.txt", mapping);
    write("track.csv", csv_of(clip_.points));
  }

  /// A track with all digits.
  std::string csv_of(const Frames& points, bool with_times = true) const {
    std::ostringstream text;
    text.precision(17);
    text << (with_times ? "frame,time" : "frame");
    for (int i = 0; i < points.cols() / 2; ++i) text << ",x" << i << ",y" << i;
    for (int f = 0; f < points.rows(); ++f) {
      text << '\n' << f;
      if (with_times) text << ',' << clip_.times[f];
      for (const double value : points.row(f)) text << ',' << value;
    }
    return text.str() + '\n';
  }

  FittedCoefficients fitted(const std::string& arguments, const std::string& name) const {
    const auto result = run("fit " + arguments + " --model face -o " + name + ".npy");
    EXPECT_EQ(result.code, 0) << result.err;
    return read_fit(folder_ / (name + ".fit.json"));
  }

  Frames frames_of(const std::string& name) const {
    return read_sequence((folder_ / name).string()).sequence.positions();
  }

  test::SyntheticClip clip_;
};

TEST_F(Fit, SaysWhereSmoothnessIsATimeAndTheTrackHasNone) {
  write("timeless.csv", csv_of(clip_.points, false));
  const std::string said = "--smoothness takes its frames for 30 a second";
  const std::string line = "fit timeless.csv --model face --force -o a.npy ";
  const auto result = run(line + "--smoothness 0.1");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr(said));
  EXPECT_THAT(run(line + "--smoothness 0.1 --fps 25").err, testing::Not(HasSubstr(said)));
  EXPECT_THAT(run(line).err, testing::Not(HasSubstr(said)));
  EXPECT_THAT(run("fit track.csv --model face -o b.npy --smoothness 0.1").err,
              testing::Not(HasSubstr(said)));
}

TEST_F(Fit, WritesTheSequenceAndItsCoefficientsBeside) {
  const auto result = run("fit track.csv --model face -o take/");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, testing::Not(HasSubstr("warning")));
  EXPECT_THAT(result.out, HasSubstr("6 frames, 20 of 20 landmarks mapped: RMS "));
  EXPECT_EQ(listing("take").size(), std::size_t{kFrames + 1});
  EXPECT_TRUE(listing("take").contains("mimetra-run.json"));
  const auto names = listing();
  EXPECT_TRUE(names.contains("take.fit.json"));
  EXPECT_TRUE(names.contains("take.rest.ply"));
  EXPECT_FALSE(names.contains("take.fit.run.json"));
  const json manifest = json::parse(text_of(folder_ / "take/mimetra-run.json"));
  EXPECT_EQ(manifest.at("outputs").size(), 2u);
  EXPECT_THAT(manifest.at("inputs").dump(), HasSubstr("face/landmarks68.txt"));
}

TEST_F(Fit, TellsEveryFrameAsJson) {
  const auto result = run("fit track.csv --model face -o a.npy --fit-out b/c.json --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  ASSERT_EQ(report.at("frames").size(), std::size_t{kFrames});
  for (const json& frame : report.at("frames")) {
    EXPECT_GT(frame.at("rms_px"), 0);
    EXPECT_GE(frame.at("iterations"), 1);
    EXPECT_EQ(frame.at("alpha").size(), 5u);
    EXPECT_EQ(frame.at("beta").size(), 4u);
    EXPECT_EQ(frame.at("camera").size(), 2u);
  }
  EXPECT_EQ(json::parse(text_of(folder_ / "b/c.json")).at("frames"), report.at("frames"));
  EXPECT_FALSE(listing().contains("a.fit.json"));
}

TEST_F(Fit, PlansWithoutWriting) {
  const auto before = listing();
  const auto result = run("fit track.csv --model face -o take --dry-run");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("track.csv: 6 frames of 20 landmarks"));
  EXPECT_THAT(result.out, HasSubstr("23 vertices, 5 identities, 4 expressions"));
  EXPECT_THAT(result.out, HasSubstr("writes  take.fit.json"));
  EXPECT_EQ(listing(), before);
}

TEST_F(Fit, IsReadAgainAsThePerformance) {
  for (const std::string shape : {"clip", "frame"}) {
    const std::string name = "take-" + shape;
    const FittedCoefficients fit = fitted("track.csv --shape " + shape, name);
    const auto person = run("convert face@" + name + ".fit.json -o " + shape + ".npy");
    ASSERT_EQ(person.code, 0);
    const std::string said = name + ".fit.json: holds an identity for each frame";
    EXPECT_EQ(person.err.find(said) != std::string::npos, shape == "frame") << person.err;
    const SequenceRead again = read_sequence((folder_ / (shape + ".npy")).string());
    const SequenceRead written = read_sequence((folder_ / (name + ".npy")).string());
    // Sums of ten products of some units, in whatever order.
    constexpr double kRounding = 1e-12;
    EXPECT_LT((again.sequence.rest() - written.sequence.rest()).cwiseAbs().maxCoeff(), kRounding);
    const double difference =
        (again.sequence.positions() - written.sequence.positions()).cwiseAbs().maxCoeff();
    if (shape == "clip") {
      EXPECT_LT(difference, kRounding);
      EXPECT_EQ(fit.identity(), fit.alpha.row(kFrames - 1).transpose());
    } else {
      // A sequence has one person, the mean of the frames'.
      EXPECT_GT(difference, 1e-3);
    }
  }
}

/// The points in images that are turned by 36 degrees, made smaller and moved.
Frames moved_images(const Frames& points) {
  Frames moved = points;
  const Eigen::Rotation2D<double> turn(std::numbers::pi / 5);
  for (Eigen::Index f = 0; f < moved.rows(); ++f) {
    for (Eigen::Index i = 0; i < moved.cols(); i += 2) {
      const Eigen::Vector2d point = moved.row(f).segment<2>(i);
      moved.row(f).segment<2>(i) = (0.37 * (turn * point) + Eigen::Vector2d(1000, -20)).transpose();
    }
  }
  return moved;
}

TEST_F(Fit, DoesNotChangeWithTheImagesScaleRotationAndPlace) {
  write("moved.csv", csv_of(moved_images(clip_.points)));
  for (const std::string solver : {"joint", "alternating"}) {
    for (const std::string shape : {"clip", "frame"}) {
      const std::string options = " --solver " + solver + " --shape " + shape;
      const std::string name = solver + "-" + shape;
      const FittedCoefficients here = fitted("track.csv" + options, name);
      const FittedCoefficients there = fitted("moved.csv" + options, name + "-moved");
      EXPECT_LT((here.alpha - there.alpha).cwiseAbs().maxCoeff(), 1e-6) << name;
      EXPECT_LT((here.beta - there.beta).cwiseAbs().maxCoeff(), 1e-6) << name;
    }
  }
}

/// Images have y down: what turns there by an angle turns by its negative for a viewer.
TEST_F(Fit, TurnsAsTheHeadDoesWhereItIsAskedTo) {
  write("moved.csv", csv_of(moved_images(clip_.points)));
  fitted("track.csv", "still");
  fitted("track.csv --head-motion keep", "here");
  fitted("moved.csv --head-motion keep", "there");
  const SequenceRead still = read_sequence((folder_ / "still.npy").string());
  const SequenceRead here = read_sequence((folder_ / "here.npy").string());
  EXPECT_EQ(here.sequence.rest(), still.sequence.rest());
  EXPECT_EQ(here.sequence.times(), still.sequence.times());
  const Eigen::RowVector3d middle = here.sequence.rest().colwise().mean();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(-std::numbers::pi / 5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Frames there = frames_of("there.npy");
  const double size = (here.sequence.rest().rowwise() - middle).norm();
  for (int f = 0; f < kFrames; ++f) {
    const Positions frame = here.sequence.frame(f);
    EXPECT_GT((frame - still.sequence.frame(f)).norm(), 0.01 * size) << f;
    const Positions expected = ((frame.rowwise() - middle) * turn.transpose()).rowwise() + middle;
    const Eigen::Map<const Positions> found(there.row(f).data(), frame.rows(), 3);
    EXPECT_LT((found - expected).norm(), 1e-5 * size) << f;
  }
}

TEST_F(Fit, TakesAFolderOfPointsInNaturalOrder) {
  std::filesystem::create_directory(folder_ / "points");
  for (int f = 0; f < kFrames; ++f) {
    std::ostringstream text;
    text.precision(17);
    text << "version: 1\nn_points: 20\n{\n";
    for (Eigen::Index i = 0; i < clip_.points.cols(); i += 2) {
      text << clip_.points(f, i) + 1 << ' ' << clip_.points(f, i + 1) + 1 << '\n';
    }
    write("points/" + std::to_string(5 * f) + ".pts", text.str() + "}\n");
  }
  const FittedCoefficients track = fitted("track.csv", "a");
  for (const std::string input : {"points", "'points/*.pts'", "points/%d.pts"}) {
    const FittedCoefficients fit = fitted(input + " --fps 25 --force", "b");
    // 1 was added and taken away again: some 1e-13 px, times the solver's condition.
    EXPECT_LT((fit.alpha - track.alpha).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((fit.beta - track.beta).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((fit.times - track.times).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST_F(Fit, TakesAPartOfTheFramesWithTheirTimes) {
  const FittedCoefficients fit = fitted("track.csv --frames 1::2 --shape frame", "part");
  ASSERT_EQ(fit.frames(), 3);
  EXPECT_EQ(fit.times[1], clip_.times[3]);
}

TEST_F(Fit, OfOneFrameIsAMesh) {
  const auto result = run("fit track.csv --frames 2:3 --model face -o one.obj");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(listing().contains("one.fit.json"));
  EXPECT_TRUE(listing().contains("one.run.json"));
  EXPECT_EQ(frames_of("one.obj").cols(), clip_.model.mean().size());
}

TEST_F(Fit, SaysThatLandmarksAreInAnotherOrder) {
  const auto clean = run("fit track.csv --model face -o clean.npy");
  EXPECT_THAT(clean.err, testing::Not(HasSubstr("warning")));
  Frames shifted(clip_.points.rows(), clip_.points.cols());
  shifted << clip_.points.rightCols(2 * 3), clip_.points.leftCols(clip_.points.cols() - 2 * 3);
  write("shifted.csv", csv_of(shifted));
  const auto wrong = run("fit shifted.csv --model face -o wrong.npy");
  ASSERT_EQ(wrong.code, 0) << wrong.err;
  EXPECT_THAT(wrong.err, testing::AllOf(HasSubstr("of the face's radius from the fitted face"),
                                        HasSubstr("are they in the order of the mapping")));
}

}  // namespace
}  // namespace mimetra
