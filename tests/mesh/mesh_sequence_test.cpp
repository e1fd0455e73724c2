#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Connectivity triangle() {
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  return Connectivity::from_triangles(3, triangles);
}

/// Frame f holds 100 f + 0, 1, ... 8.
Frames counting_frames(int count) {
  Frames frames(count, 9);
  for (int f = 0; f < count; ++f) frames.row(f).setLinSpaced(100 * f, 100 * f + 8);
  return frames;
}

MeshSequence counting(int count) {
  return {triangle(), counting_frames(count)};
}

TEST(MeshSequence, ShowsAFrameInItsOwnMemoryAsRowsOfPoints) {
  const MeshSequence sequence = counting(3);
  EXPECT_EQ(sequence.frame(2).row(1), Eigen::RowVector3d(203, 204, 205));
  EXPECT_EQ(sequence.frame(1).data(), sequence.positions().row(1).data());
}

TEST(MeshSequence, WithoutTimesRunsAtTheDefaultRate) {
  EXPECT_DOUBLE_EQ(counting(4).times()[3], 3 / kDefaultFramesPerSecond);
  EXPECT_EQ(counting(1).times()[0], 0);
}

TEST(MeshSequence, WithoutRestRestsInItsFirstFrame) {
  const MeshSequence sequence = counting(2);
  EXPECT_FALSE(sequence.rest_is_known());
  EXPECT_EQ(sequence.rest(), sequence.frame(0));
}

TEST(MeshSequence, KnowsTheRestPoseItWasGiven) {
  const MeshSequence sequence(triangle(), counting_frames(2), {}, Positions::Ones(3, 3));
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(sequence.rest(), Positions::Ones(3, 3));
}

TEST(MeshSequence, RefusesPartsThatDoNotFit) {
  const auto refusal = [](const char* message) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(message));
  };
  EXPECT_THAT([] { counting(0); }, refusal("at least one frame"));
  EXPECT_THAT([] { MeshSequence(std::shared_ptr<const Connectivity>(), counting_frames(1)); },
              refusal("needs a connectivity"));
  EXPECT_THAT([] { MeshSequence(triangle(), Frames::Zero(2, 12)); },
              refusal("12 coordinates, expected 3 x 3"));
  EXPECT_THAT([] { MeshSequence(triangle(), counting_frames(2), Eigen::VectorXd::Zero(3)); },
              refusal("3 times for 2 frames"));
  EXPECT_THAT([] { counting(2).with_rest(Positions::Zero(4, 3)); },
              refusal("rest pose has 4 vertices, expected 3"));
  EXPECT_THAT([] { counting(2).with_frames(Frames::Zero(3, 9)); }, refusal("3 frames, expected 2"));
}

TEST(Slice, TakesEveryStepthFrameAndItsTimeOfTheSameFaces) {
  const MeshSequence sequence = counting(10), part = sequence.slice(1, 8, 3);
  ASSERT_EQ(part.frames(), 3);
  EXPECT_EQ(part.positions()(2, 0), 700);
  EXPECT_DOUBLE_EQ(part.times()[2], 7 / kDefaultFramesPerSecond);
  EXPECT_EQ(part.shared_connectivity(), sequence.shared_connectivity());
}

TEST(Slice, KeepsAKnownRestPoseOrRestsInItsOwnFirstFrame) {
  const MeshSequence sequence = counting(3);
  EXPECT_EQ(sequence.with_rest(Positions::Ones(3, 3)).slice(1, 3).rest(), Positions::Ones(3, 3));
  EXPECT_EQ(sequence.slice(1, 3).rest(), sequence.frame(1));
}

TEST(Slice, OutsideTheSequenceIsRefused) {
  const auto slice = [](int first, int last, int step) {
    return [=] { counting(3).slice(first, last, step); };
  };
  const auto refusal =
      ThrowsMessage<std::invalid_argument>(HasSubstr("0 <= first < last <= frames"));
  EXPECT_THAT(slice(0, 4, 1), refusal);
  EXPECT_THAT(slice(-1, 2, 1), refusal);
  EXPECT_THAT(slice(2, 2, 1), refusal);
  EXPECT_THAT(slice(0, 3, 0), refusal);
}

TEST(WithFrames, KeepsTimesAndRest) {
  const MeshSequence sequence(triangle(), counting_frames(2), Eigen::Vector2d(5, 7));
  const MeshSequence other = sequence.with_frames(Frames::Zero(2, 9));
  EXPECT_EQ(other.times(), Eigen::Vector2d(5, 7));
  EXPECT_EQ(other.rest(), sequence.rest());
  EXPECT_FALSE(other.rest_is_known());
  EXPECT_TRUE(other.positions().isZero(0));
}

TEST(Motion, OfAUniformShiftIsItsLengthTimesTheShareOfFrames) {
  Frames frames = counting_frames(1).replicate(4, 1);
  frames.row(3).array() += 1;
  // One frame of four is sqrt(3) away: sqrt(3 / 4), up to rounding.
  EXPECT_NEAR(motion(MeshSequence(triangle(), frames)), std::sqrt(0.75), 1e-15);
}

TEST(Motion, OfNothingIsZero) {
  EXPECT_EQ(motion(MeshSequence()), 0);
}

}  // namespace
}  // namespace mimetra
