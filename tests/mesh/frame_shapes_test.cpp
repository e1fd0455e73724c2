#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A ball that is pulled long, turned, moved and dented: what a face may do.
class FrameShapes : public testing::Test {
 protected:
  FrameShapes() : ball_(test::sphere(3)) {
    ball_.positions.col(1) *= 1.4;
    for (int f = 0; f < 9; ++f) poses_.push_back(pose(f));
  }

  Positions pose(int f) const {
    Positions moved = ball_.positions;
    moved.col(2).array() += 0.1 * f * moved.col(0).array().square();
    const Eigen::AngleAxisd turn(0.3 * f, Eigen::Vector3d(1, 2, f).normalized());
    moved = moved * turn.toRotationMatrix().transpose();
    return moved.rowwise() + Eigen::RowVector3d(5 * f, 0, -f);
  }

  MeshSequence sequence() const {
    Frames frames(static_cast<Eigen::Index>(poses_.size()), ball_.positions.size());
    for (std::size_t f = 0; f < poses_.size(); ++f) {
      frames.row(static_cast<Eigen::Index>(f)) = poses_[f].reshaped<Eigen::RowMajor>();
    }
    return {Connectivity::from_triangles(static_cast<int>(ball_.positions.rows()), ball_.triangles),
            frames,
            {},
            ball_.positions};
  }
  OddFrames odd() const {
    const MeshSequence sequence = this->sequence();
    return odd_frames(sequence, frame_shapes(sequence));
  }

  test::Shape ball_;
  std::vector<Positions> poses_;
};

TEST_F(FrameShapes, OfOnePersonAreNotOdd) {
  const OddFrames found = odd();
  EXPECT_THAT(found.of_other_size, IsEmpty());
  EXPECT_THAT(found.mirrored, IsEmpty());
  EXPECT_THAT(found.torn, IsEmpty());
  EXPECT_GE(found.usual_spread, spread(ball_.positions));
}

TEST_F(FrameShapes, InAnotherUnitOrWithoutAnyAreOfAnotherSize) {
  poses_[2] *= 100;
  poses_[5] *= 0.01;
  poses_[7].setZero();
  const OddFrames found = odd();
  EXPECT_THAT(found.of_other_size, ElementsAre(2, 5, 7));
  EXPECT_THAT(found.mirrored, IsEmpty());
  EXPECT_THAT(found.torn, IsEmpty());
}

TEST_F(FrameShapes, OfWhichOneAxisIsTurnedAroundAreMirrored) {
  poses_[1].col(0) *= -1;
  poses_[6] *= -1;
  poses_[8].col(0) *= -1;
  poses_[8].col(1) *= -1;  // half a turn
  EXPECT_THAT(odd().mirrored, ElementsAre(1, 6));
}

TEST_F(FrameShapes, NumberedOtherwiseOrWithAVertexFarAwayAreTorn) {
  poses_[3].row(17) += Eigen::RowVector3d(0, 3, 0);
  poses_[4] = Positions(poses_[4].colwise().reverse());
  const OddFrames found = odd();
  EXPECT_THAT(found.torn, ElementsAre(3, 4));
  EXPECT_THAT(found.of_other_size, IsEmpty());
}

TEST_F(FrameShapes, WithAVertexThatStraysInOneFrameAreSpiked) {
  poses_[3].row(17) += Eigen::RowVector3d(0, 0.4, 0);
  poses_[8].row(20) += Eigen::RowVector3d(0.4, 0, 0);  // the last
  const OddFrames found = odd();
  EXPECT_THAT(found.spiked, ElementsAre(3, 8));
  EXPECT_THAT(found.torn, IsEmpty());
  // One that stays away is a shape.
  for (std::size_t f = 3; f < poses_.size(); ++f) {
    poses_[f] = pose(static_cast<int>(f));
    poses_[f].row(17) += Eigen::RowVector3d(0, 0.4, 0);
  }
  EXPECT_THAT(odd().spiked, IsEmpty());
}

TEST_F(FrameShapes, WithVerticesThatStrayForAWhileAreSpiked) {
  for (const int f : {2, 3, 4, 5}) poses_[f].row(17) += Eigen::RowVector3d(0, 0.4 + 0.01 * f, 0);
  for (const int f : {3, 4}) poses_[f].row(20) += Eigen::RowVector3d(0.42, 0, 0);
  EXPECT_THAT(odd().spiked, ElementsAre(2, 3, 4, 5));
}

TEST_F(FrameShapes, WithAVertexThatGlidesAwayAndBackAreNotSpiked) {
  const double away[] = {0, 0.1, 0.2, 0.3, 0.4, 0.3, 0.2, 0.1, 0};
  for (std::size_t f = 0; f < poses_.size(); ++f) {
    poses_[f].row(17) += Eigen::RowVector3d(0, away[f], 0);
  }
  EXPECT_THAT(odd().spiked, IsEmpty());
}

TEST_F(FrameShapes, AreDescribedWithTheVertexThatStrays) {
  poses_[3].row(17) += Eigen::RowVector3d(0, 0.4, 0);
  const MeshSequence sequence = this->sequence();
  const std::vector<FrameShape> shapes = frame_shapes(sequence);
  EXPECT_THAT(described(odd_frames(sequence, shapes), shapes),
              ElementsAre(testing::StartsWith("frame 3 is spiked: vertex 17 alone lies 0.3")));
}

TEST_F(FrameShapes, AreThoseOfTheSurfaceAlone) {
  // A vertex of no triangle, and one of a triangle without area, far away in one frame.
  const Eigen::Index count = ball_.positions.rows();
  ball_.triangles.conservativeResize(ball_.triangles.rows() + 1, 3);
  ball_.triangles.bottomRows(1) << 0, 0, static_cast<int>(count);
  ball_.positions.conservativeResize(count + 2, 3);
  ball_.positions.bottomRows(2).setZero();
  for (Positions& pose : poses_) {
    pose.conservativeResize(count + 2, 3);
    pose.bottomRows(2).setZero();
  }
  poses_[4].bottomRows(2).setConstant(3000);
  EXPECT_FALSE(odd().any());
  EXPECT_EQ(spread(poses_[4], ball_.triangles), spread(poses_[4].topRows(count)));
}

TEST(CapturedFrameShapes, AreNotOdd) {
  const auto data = test::shared_path("data");
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data beside the project";
  const MeshSequence performance =
      test::captured_performance(data / "ict-face/neutral.obj", data / "ict-face/expressions",
                                 data / "captures/talking-60fps-1200.csv", 60);
  const OddFrames found = odd_frames(performance, frame_shapes(performance));
  EXPECT_THAT(found.of_other_size, IsEmpty());
  EXPECT_THAT(found.mirrored, IsEmpty());
  EXPECT_THAT(found.torn, IsEmpty());
  EXPECT_THAT(found.spiked, IsEmpty());
  for (const int f : {0, performance.frames() / 2, performance.frames() - 1}) {
    const Positions pose = performance.frame(f);
    EXPECT_LT(share_of_other_edges(pose, performance.rest(), performance.triangles()), 0.02);
    // A number off by one, as where vertices are counted from 1.
    Positions other = pose;
    other << pose.bottomRows(pose.rows() - 1), pose.topRows(1);
    EXPECT_GT(share_of_other_edges(other, performance.rest(), performance.triangles()), 0.3);
  }
}

TEST_F(FrameShapes, TellAnotherNumberingByTheirEdges) {
  const Positions& ball = ball_.positions;
  const auto share = [this](const Positions& pose) {
    return share_of_other_edges(pose, ball_.positions, ball_.triangles);
  };
  EXPECT_EQ(share(ball), 0);
  EXPECT_EQ(share(3 * ball), 0);
  EXPECT_LT(share(pose(2)), 0.02);
  Positions other(ball.rows(), 3);
  ASSERT_NE(ball.rows() % 7, 0);
  for (Eigen::Index v = 0; v < ball.rows(); ++v) other.row(v * 7 % ball.rows()) = ball.row(v);
  EXPECT_GT(share(other), 0.5);
  EXPECT_EQ(share(0 * ball), 0);
  EXPECT_EQ(share_of_other_edges(ball, ball, Triangles(0, 3)), 0);
}

TEST_F(FrameShapes, ThatJumpAwayAndBackAreOdd) {
  for (Positions& pose : poses_) pose = ball_.positions;
  poses_[4].col(1).array() += 1.4;
  EXPECT_THAT(odd().jumping, ElementsAre(4));
  // A cut is no jump: the frames after it stay there.
  for (std::size_t f = 5; f < poses_.size(); ++f) poses_[f].col(1).array() += 1.4;
  EXPECT_THAT(odd().jumping, IsEmpty());
}

}  // namespace
}  // namespace mimetra
