#include <bit>
#include <cstdint>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A number as one byte after the other, written without any help of the library.
template <typename Number>
std::string bytes_in(std::endian order, Number number) {
  std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

constexpr auto kLittle = std::endian::little, kBig = std::endian::big;

/// Positions of frame f of an octahedron: all that single precision holds exactly.
Positions octahedron_pose(int f) {
  return test::octahedron().positions.array() + 0.25 * f;
}

std::string floats(int frames, std::endian order) {
  std::string bytes;
  for (int f = 0; f < frames; ++f) {
    const Positions pose = octahedron_pose(f);
    for (Eigen::Index i = 0; i < pose.size(); ++i) {
      bytes += bytes_in(order, static_cast<float>(pose.data()[i]));
    }
  }
  return bytes;
}

/// [Autodesk's PointCache2: 12 characters, version, points, start frame, sample rate, samples]
std::string pc2_bytes(int frames, float start = 0, float rate = 1, int version = 1) {
  return std::string("POINTCACHE2\0", 12) + bytes_in(kLittle, version) + bytes_in(kLittle, 6) +
         bytes_in(kLittle, start) + bytes_in(kLittle, rate) + bytes_in(kLittle, frames) +
         floats(frames, kLittle);
}

/// [LightWave's MDD: frames, points, a time each, then the positions]
std::string mdd_bytes(const std::vector<float>& times) {
  std::string bytes = bytes_in(kBig, static_cast<std::int32_t>(times.size())) + bytes_in(kBig, 6);
  for (const float time : times) bytes += bytes_in(kBig, time);
  return bytes + floats(static_cast<int>(times.size()), kBig);
}

MeshSequence moving_octahedron(int frames, const Eigen::RowVector3d& shift = {0, 0, 0}) {
  const TriMesh mesh = test::mesh_of(test::octahedron());
  Frames poses(frames, mesh.positions.size());
  for (int f = 0; f < frames; ++f) {
    const Positions pose = octahedron_pose(f).rowwise() + shift;
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  const Positions rest = mesh.positions.rowwise() + shift;
  return {mesh.connectivity, poses, {}, rest};
}

class PointCaches : public testing::Test {
 protected:
  void SetUp() override {
    write_mesh(folder_ / "a.topology.ply", test::mesh_of(test::octahedron()));
  }

  MeshSequence read(const std::string& name, const ReadOptions& options = {}) const {
    return read_sequence((folder_ / name).string(), options).sequence;
  }
  std::string error(const std::string& name, const std::string& bytes) const {
    write_bytes(folder_ / name, bytes);
    return message_of<IoError>([&] { read(name); });
  }

  TemporaryFolder folder_;
};

TEST_F(PointCaches, Pc2IsReadAsItsDescriptionSays) {
  write_bytes(folder_ / "a.pc2", pc2_bytes(3));
  const MeshSequence sequence = read("a.pc2");
  ASSERT_EQ(sequence.frames(), 3);
  for (int f = 0; f < 3; ++f) EXPECT_EQ(sequence.frame(f), octahedron_pose(f));
  EXPECT_EQ(sequence.times()[2], 2 / kDefaultFramesPerSecond);
}

TEST_F(PointCaches, Pc2IsSampledEverySoManyFrames) {
  write_bytes(folder_ / "a.pc2", pc2_bytes(3, 1, 0.5));
  EXPECT_DOUBLE_EQ(read("a.pc2", {.fps = 25}).times()[2], (1 + 2 * 0.5) / 25);
}

TEST_F(PointCaches, Pc2IsWrittenAsItsDescriptionSays) {
  write_sequence(moving_octahedron(3), folder_ / "b.pc2");
  EXPECT_EQ(read_file(folder_ / "b.pc2"), pc2_bytes(3));
  EXPECT_THAT(folder_.names(),
              ElementsAre("a.topology.ply", "b.pc2", "b.rest.ply", "b.topology.ply"));
}

TEST_F(PointCaches, Pc2KeepsEvenTimes) {
  const MeshSequence sequence = moving_octahedron(3);
  write_sequence(MeshSequence(sequence.shared_connectivity(), sequence.positions(),
                              Eigen::Vector3d(0.5, 0.75, 1)),
                 folder_ / "b.pc2");
  // Single precision holds these exactly.
  EXPECT_TRUE(read("b.pc2").times().isApprox(Eigen::Vector3d(0.5, 0.75, 1), 1e-15));
}

TEST_F(PointCaches, Pc2CountsFramesOfTheSequencesOwnRate) {
  const MeshSequence sequence = moving_octahedron(3);
  write_sequence(MeshSequence(sequence.shared_connectivity(), sequence.positions(),
                              Eigen::Vector3d(1, 1.25, 1.5)),
                 folder_ / "b.pc2");
  EXPECT_EQ(read_file(folder_ / "b.pc2"), pc2_bytes(3, 4, 1));
  EXPECT_THAT(folder_.names(), testing::Contains("b.times.csv"));
}

TEST_F(PointCaches, MddRefusesTimesThatItWouldMakeOne) {
  const MeshSequence sequence = moving_octahedron(3);
  const double day = 86400;
  const MeshSequence late(sequence.shared_connectivity(), sequence.positions(),
                          Eigen::Vector3d(day, day + 1.0 / 240, day + 2.0 / 240));
  EXPECT_THAT(message_of<MismatchError>([&] { write_sequence(late, folder_ / "b.mdd"); }),
              HasSubstr("b.mdd: .mdd holds times in single precision, in which frame 2 at 86400"));
  EXPECT_THAT(folder_.names(), ElementsAre("a.topology.ply"));
}

TEST_F(PointCaches, MddIsReadAsItsDescriptionSays) {
  write_bytes(folder_ / "a.mdd", mdd_bytes({0, 0.5, 2}));
  const MeshSequence sequence = read("a.mdd");
  ASSERT_EQ(sequence.frames(), 3);
  for (int f = 0; f < 3; ++f) EXPECT_EQ(sequence.frame(f), octahedron_pose(f));
  EXPECT_EQ(sequence.times(), Eigen::Vector3d(0, 0.5, 2));
}

TEST_F(PointCaches, MddIsWrittenAsItsDescriptionSays) {
  const MeshSequence sequence = moving_octahedron(3);
  write_sequence(MeshSequence(sequence.shared_connectivity(), sequence.positions(),
                              Eigen::Vector3d(0, 0.5, 2)),
                 folder_ / "b.mdd");
  EXPECT_EQ(read_file(folder_ / "b.mdd"), mdd_bytes({0, 0.5, 2}));
}

TEST_F(PointCaches, KeepTheRestPoseBesideThem) {
  for (const std::string name : {"b.pc2", "c.mdd"}) {
    write_sequence(moving_octahedron(2), folder_ / name);
    EXPECT_TRUE(read(name).rest_is_known());
    EXPECT_EQ(read(name).rest(), octahedron_pose(0));
  }
}

TEST_F(PointCaches, EveryPrefixIsAnError) {
  const std::string pc2 = pc2_bytes(1), mdd = mdd_bytes({0});
  for (std::size_t size = 0; size < pc2.size(); ++size) {
    EXPECT_THAT(error("a.pc2", pc2.substr(0, size)), HasSubstr("a.pc2: is truncated")) << size;
  }
  for (std::size_t size = 0; size < mdd.size(); ++size) {
    EXPECT_THAT(error("a.mdd", mdd.substr(0, size)), HasSubstr("a.mdd: is truncated")) << size;
  }
}

TEST_F(PointCaches, WhatFollowsTheLastFrameIsAnError) {
  EXPECT_THAT(error("a.pc2", pc2_bytes(2) + "?"), HasSubstr("1 bytes follow its 2 frames"));
  EXPECT_THAT(error("a.mdd", mdd_bytes({0, 1}) + "??"), HasSubstr("2 bytes follow its 2 frames"));
}

TEST_F(PointCaches, WrongHeadersAreNamed) {
  std::string other = pc2_bytes(1);
  other[0] = 'p';
  EXPECT_THAT(error("a.pc2", other), HasSubstr("is no PC2 point cache"));
  EXPECT_THAT(error("a.pc2", pc2_bytes(1, 0, 1, 2)), HasSubstr("has PC2 version 2, expected 1"));
  EXPECT_THAT(error("a.pc2", pc2_bytes(1, 0, 0)), HasSubstr("expected more than 0"));
  EXPECT_THAT(error("a.pc2", pc2_bytes(0)), HasSubstr("has 0 frames of 6 vertices"));
  EXPECT_THAT(error("a.mdd", mdd_bytes({})), HasSubstr("has 0 frames of 6 vertices"));
  EXPECT_THAT(error("a.mdd", bytes_in(kBig, -1) + bytes_in(kBig, 6)), HasSubstr("has -1 frames"));
}

TEST_F(PointCaches, HugeClaimsAreFoundBeforeMemoryIsAskedFor) {
  const std::string huge = bytes_in(kLittle, 1 << 29);
  std::string pc2 = pc2_bytes(1).replace(16, 4, huge).replace(28, 4, huge);
  EXPECT_THAT(error("a.pc2", pc2), HasSubstr("is truncated"));
  EXPECT_THAT(error("a.pc2", pc2.substr(0, 32)), HasSubstr("is truncated"));
  EXPECT_THAT(error("a.mdd", bytes_in(kBig, 1 << 29) + bytes_in(kBig, 1 << 29)),
              HasSubstr("is truncated"));
  EXPECT_THAT(error("a.mdd", bytes_in(kBig, 1 << 30) + bytes_in(kBig, 6)),
              HasSubstr("has 1073741824 frames of 6 vertices, expected 1 to 715827882"));
}

TEST_F(PointCaches, TimesOfMddRise) {
  EXPECT_THAT(error("a.mdd", mdd_bytes({0, 1, 1})), HasSubstr("frame 2 is at 1 s"));
  EXPECT_THAT(error("a.mdd", mdd_bytes({std::numeric_limits<float>::quiet_NaN()})),
              HasSubstr("frame 0 is at nan s"));
}

TEST_F(PointCaches, APositionThatIsNotFiniteIsNamed) {
  std::string bytes = pc2_bytes(3);
  const std::string infinite = bytes_in(kLittle, std::numeric_limits<float>::infinity());
  bytes.replace(32 + 4 * (2 * 18 + 3 * 5 + 1), 4, infinite);
  EXPECT_THAT(error("a.pc2", bytes), HasSubstr("a.pc2: frame 2: vertex 5 has no usable position"));
}

TEST_F(PointCaches, RefuseWhatSinglePrecisionWouldSpoil) {
  const MeshSequence far_out = moving_octahedron(2, {1e6, 0, 0});
  for (const std::string name : {"b.pc2", "b.mdd"}) {
    EXPECT_THAT(message_of<MismatchError>([&] { write_sequence(far_out, folder_ / name); }),
                HasSubstr("holds single precision only"));
  }
  EXPECT_THAT(folder_.names(), ElementsAre("a.topology.ply"));
}

TEST_F(PointCaches, ReadOnlyTheFramesThatAreAskedFor) {
  // The first two frames have no finite position; nobody looks at them.
  std::string bytes = pc2_bytes(3);
  const std::string infinite = bytes_in(kLittle, std::numeric_limits<float>::infinity());
  bytes.replace(32, 4, infinite).replace(32 + 4 * 18, 4, infinite);
  write_bytes(folder_ / "a.pc2", bytes);
  EXPECT_EQ(read("a.pc2", {.frames = "2:3"}).frame(0), octahedron_pose(2));
}

/// A file that takes no room on disk: only its header and its last frame are written.
TEST(PointCache, OfMoreThanFourGigabytesIsReadToItsEnd) {
  const TemporaryFolder folder;
  constexpr int kVertices = 20000, kFrames = 20000;
  constexpr std::size_t kFrameBytes = 3 * sizeof(float) * kVertices;
  Triangles faces(1, 3);
  faces << 0, 1, 2;
  write_mesh(folder / "take.topology.ply",
             {Positions::Zero(kVertices, 3), Connectivity::from_triangles(kVertices, faces)});
  std::string head("POINTCACHE2\0", 12);
  for (const std::int32_t value : {1, kVertices}) head += bytes_in(kLittle, value);
  for (const float value : {0.f, 1.f}) head += bytes_in(kLittle, value);
  head += bytes_in(kLittle, std::int32_t{kFrames});
  write_bytes(folder / "take.pc2", head);
  std::error_code error;
  std::filesystem::resize_file(folder / "take.pc2", head.size() + kFrames * kFrameBytes, error);
  if (error) GTEST_SKIP() << "no sparse files here: " << error.message();
  {
    std::fstream file(folder / "take.pc2", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(head.size() + kFrames * kFrameBytes - sizeof(float)));
    const std::string last = bytes_in(kLittle, 7.f);
    file.write(last.data(), static_cast<std::streamsize>(last.size()));
  }
  const auto open = open_sequence(folder / "take.pc2");
  EXPECT_EQ(open.frames->frames(), kFrames);
  EXPECT_EQ(open.frames->read(kFrames - 1, 1)(0, 3 * kVertices - 1), 7);
  EXPECT_EQ(open.frames->read(kFrames / 2, 1).cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace mimetra
