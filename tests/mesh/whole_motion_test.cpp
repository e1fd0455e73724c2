#include "toolkit/mesh/whole_motion.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
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

TEST(WholeMotion, LeavesNothingBehind) {
  // A tenth of a ball stays where it is: most of the motion is one, but not of the whole.
  const Positions rest = bumpy_sphere(3).positions;
  Positions pose = rest.rowwise() + Eigen::RowVector3d(0, 0, 0.5);
  EXPECT_NEAR(whole_motion(rest, pose).of_stillest, 1, kRounding);
  EXPECT_TRUE(whole_motion(rest, pose).moves());
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    if (rest(v, 2) < -0.8) pose.row(v) = rest.row(v);
  }
  const WholeMotion whole = whole_motion(rest, pose);
  EXPECT_LT(whole.left_by_motion, WholeMotion::kMostlyMoved);
  EXPECT_LT(whole.of_stillest, 0.02);
  EXPECT_FALSE(whole.moves());
}

TEST(WholeMotion, MayLeaveItsAxisWhereItIs) {
  const Positions rest = test::grid(9, 9).positions;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const WholeMotion whole = whole_motion(rest, rest * turn.transpose());
  EXPECT_NEAR(whole.of_stillest, 1, kRounding);
  EXPECT_TRUE(whole.moves());
}

TEST(WholeMotion, IsNoneOfRounding) {
  const Positions rest = bumpy_sphere(2).positions.rowwise() + Eigen::RowVector3d(0, 3, 0);
  const Positions rounded = rest.cast<float>().cast<double>();
  EXPECT_FALSE(whole_motion(rest, rounded.rowwise() + Eigen::RowVector3d(1e-7, 0, 0)).moves());
}

TEST(WholeMotion, IsOfTheSurfaceAlone) {
  TriMesh mesh = test::mesh_of(bumpy_sphere(2));
  const Eigen::Index count = mesh.positions.rows();
  mesh.positions.conservativeResize(count + 1, 3);
  mesh.positions.row(count) << 0, 0, 100;
  mesh.connectivity =
      Connectivity::from_triangles(static_cast<int>(count) + 1, mesh.connectivity.triangles);
  Positions pose = mesh.positions;
  pose.topRows(count) = pulled(mesh.positions.topRows(count), 0.3);
  pose(count, 0) += 50;
  Frames frames = pose.reshaped<Eigen::RowMajor>().transpose();
  const WholeMotion whole =
      whole_motion(MeshSequence(mesh.connectivity, frames, {}, mesh.positions));
  EXPECT_FALSE(whole.moves());
  EXPECT_LT(whole.shift, 0.3);
}

/// The vertices of a pose that lie in the lowest share of the rest pose, along y.
Positions lower_part(const Positions& positions, const Positions& rest, double share) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(rest.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&rest](Eigen::Index v) { return rest(v, 1); });
  order.resize(static_cast<std::size_t>(share * static_cast<double>(rest.rows())));
  return positions(order, Eigen::all);
}

TEST(CapturedWholeMotion, IsNoneOfExpressionsNorOfALowerHalf) {
  const auto folder = test::shared_path("data") / "ict-face";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data beside the project";
  const Positions rest = test::read_plain_obj(folder / "neutral.obj").positions;
  Positions chewing = rest;
  for (const char* name : {"jawRight", "mouthRight"}) {
    const auto file = folder / "expressions" / (std::string(name) + ".obj");
    chewing += test::read_plain_obj(file).positions - rest;
  }
  for (const double share : {1.0, 0.65, 0.5, 0.35}) {
    EXPECT_FALSE(
        whole_motion(lower_part(rest, rest, share), lower_part(chewing, rest, share)).moves())
        << share;
  }
  // As a head that nods about its neck while it talks.
  const Eigen::Matrix3d nod = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::RowVector3d neck = rest.colwise().mean() - Eigen::RowVector3d(0, 5, 8);
  Positions nodding = (rest.rowwise() - neck) * nod.transpose();
  nodding.rowwise() += neck;
  EXPECT_TRUE(whole_motion(rest, nodding + 0.3 * (chewing - rest)).moves());
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
