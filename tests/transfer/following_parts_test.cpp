#include "toolkit/transfer/following_parts.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

test::Shape ball(double radius, const Eigen::RowVector3d& center) {
  test::Shape shape = test::octahedron();
  shape.positions = (radius * shape.positions).rowwise() + center;
  return shape;
}

/// A target whose first shape is the source, paired with itself, beside another part.
struct TwoParts {
  TwoParts(const test::Shape& face, const test::Shape& part)
      : source(test::mesh_of(face)), target(test::mesh_of(test::both(face, part))) {
    Correspondence pairs = Correspondence::identity(static_cast<int>(face.triangles.rows()));
    pairs.offsets.resize(static_cast<std::size_t>(target.connectivity.triangles.rows()) + 1,
                         pairs.offsets.back());
    pairs.residuals.conservativeResize(target.connectivity.triangles.rows());
    pairing = std::make_shared<const Pairing>(source, target, std::move(pairs));
  }

  FollowingParts parts() const {
    return {target.positions, target.connectivity.triangles, Weld::exact(target.positions),
            *pairing};
  }
  bool follows() const { return !parts().parts().empty(); }

  TriMesh source, target;
  std::shared_ptr<const Pairing> pairing;
};

/// The part of a sphere's surface above a height.
test::Shape cap(double radius, double from_height) {
  test::Shape shape = test::sphere(4);
  std::vector<int> above;
  for (int t = 0; t < shape.triangles.rows(); ++t) {
    const auto corners = shape.triangles.row(t);
    if (shape.positions(corners, 1).minCoeff() >= from_height) above.push_back(t);
  }
  shape.triangles = Triangles(shape.triangles(above, Eigen::all));
  shape.positions *= radius;
  return shape;
}

TEST(FollowingParts, AreThoseThatTheSurfaceEncloses) {
  const test::Shape head = test::sphere(3);
  EXPECT_TRUE(TwoParts(head, ball(0.2, {0.3, 0.2, 0.5})).follows());
  // Half of a sphere shows its back in half of all directions, as a mask does to its eyes.
  EXPECT_TRUE(TwoParts(cap(1, 0), ball(0.1, {0, 0.4, 0})).follows());
}

TEST(FollowingParts, AreThoseThatLieAgainstTheSurface) {
  const test::Shape head = test::sphere(4);
  const double size = box_diagonal(head.positions);
  EXPECT_TRUE(TwoParts(head, cap(1 + 0.015 * size, 0.9)).follows());
  EXPECT_FALSE(TwoParts(head, cap(1 + 0.03 * size, 0.9)).follows());
}

TEST(FollowingParts, AreNeitherHairNorABody) {
  const test::Shape head = test::sphere(4);
  EXPECT_FALSE(TwoParts(head, cap(1.2, -0.2)).follows());
  EXPECT_FALSE(TwoParts(head, ball(3, {0, -4.5, 0})).follows());
}

TEST(FollowingParts, MoveRigidlyWithTheSurfaceAround) {
  const test::Shape face = test::sphere(3);
  const TwoParts both(face, ball(0.2, {0.3, 0.2, 0.5}));
  const RigidTransform turn{
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
      Eigen::Vector3d(3, 2, 1)};
  const Positions moved = turn.apply(face.positions);
  Frames frames(1, moved.size());
  frames.row(0) = Eigen::Map<const Eigen::RowVectorXd>(moved.data(), moved.size());
  const MeshSequence take(test::connectivity_of(face), frames, {}, face.positions);
  const TriMesh& to = both.target;
  const VertexTransfer transfer(take.rest(), to.positions, to.connectivity.triangles,
                                all_triangles(to.connectivity.triangles),
                                {.pairing = both.pairing});
  const Frames poses = transfer.frames(take);
  const Positions expected = turn.apply(to.positions);
  EXPECT_LT((test::only_frame(poses) - expected).lpNorm<Eigen::Infinity>(), 1e-9);
  const double farthest = (expected - to.positions).bottomRows(6).rowwise().norm().maxCoeff();
  EXPECT_NEAR(both.parts().farthest(poses).at(0), farthest, 1e-9);
}

TEST(FollowingParts, AreThoseWithoutWeightOnATargetOfTheSameFaces) {
  const test::Shape face = test::sphere(3);
  const test::Shape shape =
      both(both(face, ball(0.2, {0.3, 0.2, 0.5})), ball(0.2, {-0.3, 0.2, 0.5}));
  const Weld weld = Weld::exact(shape.positions);
  const Eigen::Index count = face.positions.rows();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(shape.positions.rows());
  weights[5] = 1;          // of the face
  weights[count + 2] = 1;  // of one ball
  const FollowingParts following(shape.positions, shape.triangles, weld, weights);
  ASSERT_EQ(following.parts().size(), 1U);
  EXPECT_EQ(following.parts()[0].front(), count + 6);
  // Where the face moves as a whole, the ball goes along.
  Positions pose = shape.positions;
  pose.topRows(count + 6).rowwise() += Eigen::RowVector3d(0, -1, 2);
  following.place(Eigen::Map<Positions>(pose.data(), pose.rows(), 3));
  const Positions expected = shape.positions.rowwise() + Eigen::RowVector3d(0, -1, 2);
  EXPECT_LT((pose - expected).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(FollowingParts, LeaveAllOthersExactlyWhereTheyAre) {
  const test::Shape face = test::sphere(3);
  const TwoParts both(face, ball(3, {0, -4.5, 0}));
  const MeshSequence take = test::shaken(face, 2, 0.1);
  const TriMesh& to = both.target;
  const VertexTransfer transfer(take.rest(), to.positions, to.connectivity.triangles,
                                all_triangles(to.connectivity.triangles),
                                {.pairing = both.pairing});
  const Frames poses = transfer.frames(take);
  for (Eigen::Index f = 0; f < poses.rows(); ++f) {
    const PositionsView pose(poses.row(f).data(), to.positions.rows(), 3);
    EXPECT_EQ(Positions(pose.bottomRows(6)), Positions(to.positions.bottomRows(6)));
    EXPECT_NE(Positions(pose.topRows(6)), Positions(to.positions.topRows(6)));
  }
}

TEST(FollowingParts, TakeTheWeightAroundThemAndOthersNone) {
  const test::Shape head = test::sphere(3);
  const TwoParts eye(head, ball(0.2, {0.3, 0.2, 0.5})), body(head, ball(3, {0, -4.5, 0}));
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(head.positions.rows() + 6, 0.75);
  weights.tail(6).setConstant(0.1);
  EXPECT_EQ(eye.parts().with_surface(weights).tail(6), Eigen::VectorXd::Constant(6, 0.75));
  EXPECT_EQ(body.parts().with_surface(weights).tail(6), Eigen::VectorXd::Zero(6));
}

}  // namespace
}  // namespace mimetra
