#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TemporaryFolder;
using testing::HasSubstr;

/// Neither start, rate nor regularity could be guessed.
const Eigen::Vector4d kTimes{0.25, 0.3, 0.5, 1.0 / 3 + 1};

MeshSequence four_frames(const Eigen::VectorXd& times) {
  const TriMesh mesh = test::mesh_of(test::grid(2, 2));
  Frames poses(4, mesh.positions.size());
  for (int f = 0; f < 4; ++f) {
    const Positions pose = mesh.positions.array() + f;
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {mesh.connectivity, std::move(poses), times};
}

std::string name_of_format(const testing::TestParamInfo<std::string>& format) {
  std::string name = format.param;
  std::ranges::replace(name, '.', '_');
  return name;
}

/// Written under a name and read again.
class Times : public testing::TestWithParam<std::string> {
 protected:
  fs::path target() const { return folder_ / GetParam(); }
  fs::path beside() const { return folder_ / "take.times.csv"; }

  TemporaryFolder folder_;
};

TEST_P(Times, AreKeptWhateverTheyAreAlsoOfAPart) {
  write_sequence(four_frames(kTimes), target());
  const MeshSequence read = read_sequence(target().string()).sequence;
  EXPECT_TRUE(read.times_are_known());
  // .mdd has them in single precision.
  const double rounding = GetParam() == "take.mdd" ? 1e-7 : 0;
  EXPECT_LE((read.times() - kTimes).cwiseAbs().maxCoeff(), rounding);
  const MeshSequence part = read_sequence(target().string(), {.frames = "1::2"}).sequence;
  ASSERT_EQ(part.frames(), 2);
  EXPECT_NEAR(part.times()[1], kTimes[3], 1e-7);
  EXPECT_TRUE(part.times_are_known());
}

TEST_P(Times, AreNotReplacedByAFrameRate) {
  write_sequence(four_frames(kTimes), target());
  EXPECT_THAT(
      message_of<std::invalid_argument>([this] { read_sequence(target().string(), {.fps = 25}); }),
      HasSubstr("its 4 frames have times of their own, 0.25 to 1.333 s"));
}

INSTANTIATE_TEST_SUITE_P(Formats, Times,
                         testing::Values("take", "take.npy", "take.npz", "take.pc2", "take.mdd"),
                         name_of_format);

/// Formats that need not have times.
class UnknownTimes : public Times {};

TEST_P(UnknownTimes, StayUnknownUnlessAFrameRateGivesThem) {
  write_sequence(four_frames({}), target());
  EXPECT_FALSE(read_sequence(target().string()).sequence.times_are_known());
  EXPECT_FALSE(fs::exists(beside()));
  const MeshSequence read = read_sequence(target().string(), {.fps = 25}).sequence;
  EXPECT_TRUE(read.times_are_known());
  EXPECT_NEAR(read.times()[3], 3 / 25.0, 1e-15);
}

TEST_P(UnknownTimes, TakeTheTimesOfAnEarlierOutputAway) {
  write_sequence(four_frames(kTimes), target());
  write_sequence(four_frames({}), target(), {.overwrite = true});
  EXPECT_FALSE(read_sequence(target().string()).sequence.times_are_known());
}

INSTANTIATE_TEST_SUITE_P(Formats, UnknownTimes,
                         testing::Values("take", "take.npy", "take.npz", "take.pc2"),
                         name_of_format);

class TimesBeside : public testing::Test {
 protected:
  MeshSequence read(const std::string& name) const {
    return read_sequence((folder_ / name).string()).sequence;
  }
  void write_times(const std::string& text) const { write_bytes(folder_ / "take.times.csv", text); }

  TemporaryFolder folder_;
};

MeshSequence with_a_rest(const Eigen::VectorXd& times) {
  const MeshSequence frames = four_frames(times);
  return {frames.shared_connectivity(), frames.positions(), times,
          Positions(frames.rest().array() - 1)};
}

TEST_F(TimesBeside, AreFoundWithTheRestPoseWhereAFolderIsNamedByADot) {
  write_sequence(with_a_rest(kTimes), folder_ / "take");
  const fs::path before = fs::current_path();
  fs::create_directory(folder_ / "take/inside");
  fs::current_path(folder_ / "take");
  const MeshSequence here = read_sequence(".").sequence;
  fs::current_path(folder_ / "take/inside");
  const MeshSequence above = read_sequence("../").sequence;
  fs::current_path(before);
  for (const MeshSequence& read : {here, above}) {
    EXPECT_EQ(read.times(), kTimes);
    EXPECT_TRUE(read.rest_is_known());
  }
}

TEST_F(TimesBeside, AreFoundWithRestPoseAndFacesThroughLinks) {
  write_sequence(with_a_rest(kTimes), folder_ / "take_1");
  write_sequence(with_a_rest(kTimes), folder_ / "other.npy");
  fs::create_symlink("take_1", folder_ / "current");
  fs::create_symlink("other.npy", folder_ / "current.npy");
  for (const char* name : {"current", "current/", "current/*.ply", "current.npy"}) {
    const MeshSequence read = this->read(name);
    EXPECT_EQ(read.times(), kTimes) << name;
    EXPECT_TRUE(read.rest_is_known()) << name;
  }
}

TEST_F(TimesBeside, AndTheRestPoseAreThoseOfAPatternToo) {
  write_sequence(with_a_rest(kTimes), folder_ / "take");
  EXPECT_EQ(read("take/*.ply").rest(), with_a_rest(kTimes).rest());
  for (const char* pattern : {"take/*.ply", "take/frame_%04d.ply", "take/frame_000?.ply"}) {
    EXPECT_EQ(read(pattern).times(), kTimes) << pattern;
  }
  const MeshSequence one = read("take/*2.ply");  // no part of a sequence
  EXPECT_FALSE(one.rest_is_known());
  EXPECT_EQ(one.times()[0], 0);
  // A file that is no frame of the folder is one of the pattern: what of the rest is nobody says.
  fs::copy_file(folder_ / "take/frame_0001.ply", folder_ / "take/smile.ply");
  EXPECT_EQ(read("take").times(), kTimes);
  EXPECT_EQ(read("take/frame_*.ply").times(), kTimes);
  const SequenceRead all = read_sequence((folder_ / "take/*.ply").string());
  EXPECT_EQ(all.sequence.frames(), 5);
  EXPECT_FALSE(all.sequence.times_are_known());
  EXPECT_THAT(all.notes, testing::Contains(HasSubstr("smile.ply is none of its 4 frames")));
}

TEST_F(TimesBeside, ThatAreNotThoseOfItsFramesAreRefused) {
  write_sequence(four_frames(kTimes), folder_ / "take");
  write_times("time\n0\n1\n2\n");
  EXPECT_THAT(message_of<MismatchError>([this] { read("take"); }),
              HasSubstr("take.times.csv: 3 times, expected one for each of the 4 frames of"));
  write_times("time\n0\n1\n1\n2\n");
  EXPECT_THAT(message_of<std::exception>([this] { read("take"); }),
              HasSubstr("frame 2 is at 1 s, expected times"));
  write_times("when\n0\n1\n2\n3\n");
  EXPECT_THAT(message_of<std::exception>([this] { read("take"); }),
              HasSubstr("expected one column, 'time'"));
}

}  // namespace
}  // namespace mimetra
