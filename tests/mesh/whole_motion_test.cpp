#include "toolkit/mesh/whole_motion.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

constexpr double kRounding = 1e-12;

/// Alike from no two sides.
test::Shape bumpy_sphere(int level) {
  test::Shape shape = test::sphere(level);
  for (auto&& position : shape.positions.rowwise()) {
    position *= 1 + 0.2 * position[0] + 0.1 * position[1] * position[2];
  }
  return shape;
}

/// With one half pulled out.
Positions pulled(Positions positions, double by) {
  for (auto&& position : positions.rowwise()) position[0] += by * std::max(0.0, position[0]);
  return positions;
}

TEST(WholeMotion, OfARigidMotionIsThatMotion) {
  const Positions rest = bumpy_sphere(2).positions;
  RigidTransform motion;
  motion.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  motion.translation << 3, 0, 4;
  const WholeMotion whole = whole_motion(rest, motion.apply(rest));
  EXPECT_NEAR(whole.angle, 18 / EIGEN_PI, 1e-9);
  const Eigen::Vector3d center = rest.colwise().mean();
  EXPECT_NEAR(whole.shift, (motion.rotation * center + motion.translation - center).norm(),
              kRounding);
  EXPECT_NEAR(whole.scale, 1, kRounding);
  EXPECT_NEAR(whole.left_by_motion, 0, kRounding);
  EXPECT_TRUE(whole.moves());
  EXPECT_FALSE(whole.is_scaled());
}

TEST(WholeMotion, OfAnotherSizeIsThatSize) {
  const Positions rest = bumpy_sphere(2).positions;
  const WholeMotion whole = whole_motion(rest, 0.9 * rest);
  EXPECT_NEAR(whole.scale, 0.9, kRounding);
  EXPECT_NEAR(whole.left_by_similarity, 0, kRounding);
  EXPECT_TRUE(whole.is_scaled());
}

TEST(WholeMotion, OfADeformationIsLittleOfIt) {
  const Positions rest = bumpy_sphere(2).positions;
  const WholeMotion whole = whole_motion(rest, pulled(rest, 0.3));
  EXPECT_FALSE(whole.moves());
  EXPECT_FALSE(whole.is_scaled());
  // The literal sum of what the best motion leaves.
  const Positions pose = pulled(rest, 0.3);
  const double left = (rigid_fit(rest, pose).apply(rest) - pose).squaredNorm();
  EXPECT_NEAR(whole.left_by_motion, left / (pose - rest).squaredNorm(), kRounding);
}

TEST(WholeMotion, OfASequenceIsTheLargestAndWhatAllFramesLeave) {
  const TriMesh mesh = test::mesh_of(bumpy_sphere(2));
  const Positions aside = mesh.positions.rowwise() + Eigen::RowVector3d(0, 2, 0);
  const std::vector<Positions> poses{pulled(mesh.positions, 0.3), aside, mesh.positions};
  Frames frames(3, mesh.positions.size());
  double left = 0, all = 0;
  for (int f = 0; f < 3; ++f) {
    const Positions& pose = poses[std::size_t(f)];
    frames.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
    left += (rigid_fit(mesh.positions, pose).apply(mesh.positions) - pose).squaredNorm();
    all += (pose - mesh.positions).squaredNorm();
  }
  const WholeMotion whole =
      whole_motion(MeshSequence(mesh.connectivity, frames, {}, mesh.positions));
  EXPECT_NEAR(whole.shift, 2, kRounding);
  EXPECT_NEAR(whole.left_by_motion, left / all, kRounding);
}

TEST(WholeMotion, OfNothingIsNone) {
  const Positions rest = bumpy_sphere(1).positions;
  const WholeMotion whole = whole_motion(rest, rest);
  EXPECT_EQ(whole.left_by_motion, 1);
  EXPECT_FALSE(whole.moves());
  EXPECT_FALSE(whole.is_scaled());
}

}  // namespace
}  // namespace mimetra
