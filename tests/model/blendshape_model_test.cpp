#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/octahedron.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {
namespace {

using test::octahedron_connectivity;
using testing::HasSubstr;
using testing::ThrowsMessage;

Positions neutral() {
  return test::octahedron().positions;
}

/// Two shapes of whole numbers, so that combinations with whole weights are exact.
ShapeBasis smile_and_frown() {
  ShapeBasis basis{{"smile", "frown"}, Eigen::MatrixXd(18, 2)};
  basis.displacements.col(0).setLinSpaced(0, 17);
  basis.displacements.col(1).setConstant(-2);
  return basis;
}

BlendshapeModel model() {
  return {octahedron_connectivity(), neutral(), smile_and_frown()};
}

TEST(ShapeBasis, FindsANameOrMinusOne) {
  EXPECT_EQ(smile_and_frown().find("frown"), 1);
  EXPECT_EQ(smile_and_frown().find("Frown"), -1);
}

TEST(BlendshapeModel, PosesAsNeutralPlusWeightedDisplacements) {
  const Positions pose = model().pose(Eigen::Vector2d(2, 3));
  for (int v = 0; v < 6; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(pose(v, axis), neutral()(v, axis) + 2 * (3 * v + axis) - 3 * 2);
    }
  }
}

TEST(BlendshapeModel, IsMadeOfTheFacesThatShowItsExpressions) {
  const TriMesh rest{neutral(), *octahedron_connectivity()};
  TriMesh smile = rest, frown = rest;
  smile.positions = model().pose(Eigen::Vector2d(1, 0));
  frown.positions = model().pose(Eigen::Vector2d(0, 1));
  const BlendshapeModel made(rest, {{"smile", smile}, {"frown", frown}});
  EXPECT_EQ(made.expressions().names, model().expressions().names);
  EXPECT_EQ(made.expressions().displacements, model().expressions().displacements);
  EXPECT_EQ(made.neutral(), neutral());

  EXPECT_EQ(BlendshapeModel(rest, {}).expressions().displacements.rows(), rest.positions.size());
  Triangles flipped = rest.connectivity.triangles;
  flipped.row(0).reverseInPlace();
  const TriMesh turned{smile.positions, Connectivity::from_triangles(6, flipped)};
  EXPECT_THAT(
      ([&] {
        BlendshapeModel(rest, {{"smile", smile}, {"turned", turned}});
      }),
      ThrowsMessage<std::invalid_argument>("expression 'turned' has other faces than the neutral"));
  EXPECT_THAT(([&] {
                BlendshapeModel(rest, {{"smile", smile}, {"smile", frown}});
              }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("'smile' occurs twice")));
}

TEST(BlendshapeModel, AnimatesOnePosePerRowFromItsNeutral) {
  const BlendshapeModel face = model();
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(5, 2);
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(5, 0.5, 2);
  const MeshSequence sequence = face.animate(weights, times);
  ASSERT_EQ(sequence.frames(), 5);
  for (int f = 0; f < 5; ++f) {
    // The same sums, perhaps in another order: rounding of numbers up to 20.
    EXPECT_TRUE(sequence.frame(f).isApprox(face.pose(weights.row(f)), 1e-15));
  }
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(sequence.rest(), neutral());
  EXPECT_EQ(sequence.times(), times);
  EXPECT_EQ(sequence.shared_connectivity(), face.shared_connectivity());
}

TEST(BlendshapeModel, MayHaveNoExpressions) {
  const BlendshapeModel face(octahedron_connectivity(), neutral(), {});
  EXPECT_EQ(face.expressions().displacements.rows(), 18);
  EXPECT_EQ(face.pose(Eigen::VectorXd(0)), neutral());
  EXPECT_EQ(face.animate(Eigen::MatrixXd(3, 0)).frame(2), neutral());
}

TEST(BlendshapeModel, RefusesAnotherNumberOfWeights) {
  const auto refusal =
      ThrowsMessage<std::invalid_argument>(HasSubstr("3 weights for a model of 2 expressions"));
  EXPECT_THAT([] { model().pose(Eigen::Vector3d::Zero()); }, refusal);
  EXPECT_THAT([] { model().animate(Eigen::MatrixXd::Zero(4, 3)); }, refusal);
}

TEST(BlendshapeModel, RefusesPartsThatDoNotFit) {
  const auto refuse = [](const auto& connectivity, const Positions& rest, const ShapeBasis& shapes,
                         const char* message) {
    EXPECT_THAT([&] { BlendshapeModel(connectivity, rest, shapes); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  const auto faces = octahedron_connectivity();
  refuse(decltype(octahedron_connectivity())(), neutral(), {}, "needs a connectivity");
  refuse(faces, Positions::Zero(5, 3), {}, "the neutral has 5 vertices, expected 6");
  refuse(faces, neutral(), {{"smile"}, Eigen::MatrixXd::Zero(15, 1)}, "15 rows, expected 3 x 6");
  refuse(faces, neutral(), {{"smile"}, Eigen::MatrixXd::Zero(18, 2)},
         "2 displacement fields for 1 shape names");
  refuse(faces, neutral(), {{"smile", "smile"}, Eigen::MatrixXd::Zero(18, 2)},
         "shape name 'smile' occurs twice");
}

}  // namespace
}  // namespace mimetra
