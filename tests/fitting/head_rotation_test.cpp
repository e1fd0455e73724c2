#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "fitting/affine_camera.h"
#include "fitting/landmark_mapping.h"
#include "tests/shapes.h"

namespace mimetra {
namespace {

Eigen::Matrix3d turned_by(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
}

/// A scaled orthographic camera for which the head is turned: x right, y down. Whoever is turned to
/// the image's right, his left, shows his right side: x to -z.
AffineCamera seeing(const Eigen::Matrix3d& head, double scale) {
  AffineCamera camera;
  camera.col(3) << 300, 200;
  camera.row(0).head<3>() = scale * head.row(0);
  camera.row(1).head<3>() = -scale * head.row(1);
  return camera;
}

TEST(HeadRotation, IsThatOfAScaledOrthographicCamera) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0),
                                      Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, -2, 0.5)}) {
    for (const double degrees : {-80.0, 30.0, 170.0}) {
      const Eigen::Matrix3d head = turned_by(degrees, axis);
      EXPECT_TRUE(head_rotation(seeing(head, 0.7)).isApprox(head, 1e-13)) << degrees;
    }
  }
}

TEST(HeadRotation, IsARotationWhateverTheCameraStretches) {
  AffineCamera camera = seeing(turned_by(20, Eigen::Vector3d(1, 1, 0)), 3);
  camera(0, 1) += 0.8;
  camera.row(1) *= 1.4;
  const Eigen::Matrix3d rotation = head_rotation(camera);
  EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-14));
  EXPECT_NEAR(rotation.determinant(), 1, 1e-14);
}

TEST(TurnedAsSeen, TurnsFramesAboutTheMiddleOfTheRestPose) {
  const test::Shape shape = test::octahedron();
  Positions rest = shape.positions;
  rest.rowwise() += Eigen::RowVector3d(5, 6, 7);
  Frames frames(2, rest.size());
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(rest.data(), rest.size());
  const MeshSequence still(
      Connectivity::from_triangles(static_cast<int>(rest.rows()), shape.triangles), frames, {},
      rest);
  const Eigen::Matrix3d head = turned_by(30, Eigen::Vector3d::UnitY());
  const MeshSequence turned =
      turned_as_seen(still, {seeing(Eigen::Matrix3d::Identity(), 1), seeing(head, 4)}, {});
  EXPECT_EQ(turned.rest(), rest);
  EXPECT_TRUE(turned.frame(0).isApprox(rest, 1e-14));
  const Eigen::RowVector3d middle = rest.colwise().mean();
  const Positions expected = ((rest.rowwise() - middle) * head.transpose()).rowwise() + middle;
  EXPECT_TRUE(turned.frame(1).isApprox(expected, 1e-14));
  EXPECT_THROW(turned_as_seen(still, {}, {}), std::invalid_argument);
}

/// Right eye, left eye and lips of a face that is an octahedron, which looks along +z.
const LandmarkVertices kOctahedronFace = {{36, 1}, {45, 0}, {57, 3}};

/// The octahedron in other axes, at rest in two frames.
MeshSequence still_octahedron(const Eigen::Matrix3d& axes) {
  const TriMesh mesh = test::mesh_of(test::octahedron());
  const Positions rest = mesh.positions * axes.transpose();
  Frames frames(2, rest.size());
  frames.rowwise() = rest.reshaped<Eigen::RowMajor>().transpose();
  return {mesh.connectivity, frames, {}, rest};
}

TEST(LookingAhead, IsWhatExchangesAxesForEachOfThe24) {
  const Positions face = test::octahedron().positions;
  int rotations = 0;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (const int signs : {0, 1, 2, 3}) {
        if (x == y) continue;
        Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
        axes(x, 0) = signs & 1 ? -1 : 1;
        axes(y, 1) = signs & 2 ? -1 : 1;
        axes.col(2) = axes.col(0).cross(axes.col(1));
        EXPECT_EQ(looking_ahead(face * axes.transpose(), kOctahedronFace), axes.transpose());
        // Models lean, and so do planes through eyes and lips.
        const Eigen::Matrix3d lean = axes * turned_by(25, Eigen::Vector3d::UnitX());
        EXPECT_EQ(looking_ahead(face * lean.transpose(), kOctahedronFace), axes.transpose());
        ++rotations;
      }
    }
  }
  EXPECT_EQ(rotations, 24);
}

TEST(LookingAhead, IsNoneWithoutLandmarksOfBothEyesAndTheMouth) {
  const Positions face =
      test::octahedron().positions * turned_by(90, Eigen::Vector3d::UnitX()).transpose();
  EXPECT_NE(looking_ahead(face, kOctahedronFace), Eigen::Matrix3d::Identity());
  for (std::size_t missing = 0; missing < kOctahedronFace.size(); ++missing) {
    LandmarkVertices few = kOctahedronFace;
    few.erase(few.begin() + static_cast<std::ptrdiff_t>(missing));
    EXPECT_EQ(looking_ahead(face, few), Eigen::Matrix3d::Identity());
  }
  EXPECT_EQ(looking_ahead(face, {}), Eigen::Matrix3d::Identity());
}

/// A take in profile, or of somebody who lies on his side.
TEST(TurnedAsSeen, KeepsWhatTheWholeTakeIsTurnedBy) {
  const MeshSequence still = still_octahedron(Eigen::Matrix3d::Identity());
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    for (const double degrees : {58.0, 62.0, 90.0, -120.0}) {
      const Eigen::Matrix3d head = turned_by(degrees, axis);
      const MeshSequence turned =
          turned_as_seen(still, {seeing(head, 1), seeing(head, 2)}, kOctahedronFace);
      const Positions expected = still.rest() * head.transpose();
      for (const int f : {0, 1}) {
        EXPECT_TRUE(turned.frame(f).isApprox(expected, 1e-14)) << degrees;
      }
    }
  }
}

TEST(TurnedAsSeen, IsTheSameMotionForAModelOfOtherAxes) {
  const Eigen::Matrix3d nod = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d shake = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const auto motion = [&](const Eigen::Matrix3d& axes) {
    const MeshSequence turned = turned_as_seen(
        still_octahedron(axes),
        {seeing(nod * axes.transpose(), 2), seeing(shake * axes.transpose(), 1)}, kOctahedronFace);
    // Back in the first model's axes.
    Frames back(2, turned.positions().cols());
    for (int f = 0; f < 2; ++f) {
      const Positions pose = PositionsView(turned.positions().row(f).data(), 6, 3) * axes;
      back.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
    }
    return back;
  };
  const Frames expected = motion(Eigen::Matrix3d::Identity());
  Eigen::Matrix3d z_up, backwards;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  backwards << -1, 0, 0, 0, 1, 0, 0, 0, -1;
  for (const Eigen::Matrix3d& axes : {z_up, backwards, Eigen::Matrix3d(z_up * backwards)}) {
    EXPECT_LT((motion(axes) - expected).cwiseAbs().maxCoeff(), 1e-12) << axes;
  }
}

}  // namespace
}  // namespace mimetra
