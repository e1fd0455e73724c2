#include "toolkit/mesh/unit_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/shapes.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

/// Two frames and a rest pose that is neither of them.
std::shared_ptr<const FrameSource> moving_sphere() {
  const test::Shape shape = test::sphere(1);
  Frames frames(2, shape.positions.size());
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), frames.cols());
  frames.row(1).array() += 0.3;
  return std::make_shared<const MeshSequence>(
      Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
      frames, Eigen::Vector2d(1, 5), 0.5 * shape.positions);
}

Positions frame_of(const FrameSource& source, int frame) {
  return FrameBlock(source, frame, 1).frame(0);
}

TEST(UnitChange, ScalesFramesAndRestPoseAndKeepsTimes) {
  const auto source = moving_sphere();
  const auto scaled = with_units(source, {.scale = 1000});
  EXPECT_EQ(frame_of(*scaled, 1), 1000 * frame_of(*source, 1));
  EXPECT_EQ(scaled->rest(), 1000 * source->rest());
  EXPECT_TRUE(scaled->rest_is_known());
  EXPECT_EQ(scaled->times(), source->times());
}

TEST(UnitChange, TurnsWhatWasUpAlongYToZByARotation) {
  const auto source = moving_sphere();
  const auto turned = with_units(source, {.up = UpTurn::y_to_z});
  Eigen::Matrix3d rotation;  // its columns are where x, y and z go
  rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_EQ(rotation.determinant(), 1);
  EXPECT_EQ(frame_of(*turned, 1), frame_of(*source, 1) * rotation.transpose());
  EXPECT_EQ(turned->rest(), source->rest() * rotation.transpose());
}

TEST(UnitChange, ThereAndBackIsTheIdentity) {
  const auto source = moving_sphere();
  const auto there = with_units(source, {.scale = 0.25, .up = UpTurn::y_to_z});
  const auto back = with_units(there, {.scale = 4, .up = UpTurn::z_to_y});
  EXPECT_EQ(frame_of(*back, 0), frame_of(*source, 0));
  EXPECT_EQ(frame_of(*back, 1), frame_of(*source, 1));
  EXPECT_EQ(back->rest(), source->rest());
}

TEST(UnitChange, OfNothingIsTheSourceItself) {
  const auto source = moving_sphere();
  EXPECT_EQ(with_units(source, {}), source);
}

TEST(UnitChange, RefusesAScaleThatIsNoFactor) {
  for (const double scale : {0.0, -1.0, std::nan(""), 1e300}) {
    EXPECT_THROW(with_units(moving_sphere(), {.scale = scale}), std::invalid_argument) << scale;
  }
}

}  // namespace
}  // namespace mimetra
