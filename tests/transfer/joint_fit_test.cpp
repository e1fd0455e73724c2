#include "toolkit/transfer/joint_fit.h"

#include <gmock/gmock.h>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

constexpr int kFrames = 20;
constexpr int kExpressions = 8;

/// A patch with expressions whose bumps reach all of it: no vertex is still.
BlendshapeModel moving_everywhere() {
  BlendshapeModel model = test::model_on(test::patch(), kExpressions);
  ShapeBasis basis = model.expressions();
  for (int j = 0; j < kExpressions; ++j) {
    for (int v = 0; v < model.vertices(); ++v) {
      basis.displacements(3 * v + 2, j) += 0.5 * std::sin(0.4 * (j + 1) * model.neutral()(v, 0) +
                                                          0.3 * j * model.neutral()(v, 1) + 1);
    }
  }
  return {model.shared_connectivity(), model.neutral(), basis};
}

/// Turns of up to 20 degrees, and shifts.
std::vector<RigidTransform> turns() {
  std::vector<RigidTransform> motion(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    const Eigen::Vector3d axis = Eigen::Vector3d(std::sin(f), std::cos(2 * f), 0.5).normalized();
    motion[f] = {Eigen::AngleAxisd(0.35 * std::sin(0.7 * f + 1), axis).toRotationMatrix(),
                 Eigen::Vector3d(f, -2, 0.1 * f)};
  }
  return motion;
}

TEST(JointFit, RecoversATurnedPerformanceOfTheModelWhereNoVertexIsStill) {
  const BlendshapeModel model = moving_everywhere();
  const Eigen::MatrixXd weights = test::random_weights(kFrames, kExpressions);
  const std::vector<RigidTransform> motion = turns();
  const MeshSequence moved = with_motion(model.animate(weights), motion);
  const JointFit fit(model.neutral(), model, all_triangles(model.triangles()),
                     {.iterations = 1000});
  const HeadAndExpressions found = fit(moved, rigid_motion(moved));
  EXPECT_LT((found.weights - weights).cwiseAbs().maxCoeff(), 1e-8);
  for (int f = 0; f < kFrames; ++f) {
    EXPECT_LT((found.motion[f].rotation - motion[f].rotation).cwiseAbs().maxCoeff(), 1e-8) << f;
    EXPECT_LT((found.motion[f].translation - motion[f].translation).norm(), 1e-7) << f;
  }
}

TEST(JointFit, KeepsAFrameThatIsTheRestPose) {
  const BlendshapeModel model = moving_everywhere();
  Eigen::MatrixXd weights = test::random_weights(kFrames, kExpressions);
  weights.row(3).setZero();
  const MeshSequence performance = model.animate(weights);
  const JointFit fit(model.neutral(), model, all_triangles(model.triangles()));
  const HeadAndExpressions found = fit(performance, std::vector<RigidTransform>(kFrames));
  EXPECT_TRUE(found.motion[3].is_identity());
  EXPECT_TRUE(found.weights.row(3).isZero(0));
}

TEST(JointFit, DoesNotDependOnThreads) {
  const BlendshapeModel model = moving_everywhere();
  const MeshSequence moved =
      with_motion(model.animate(test::random_weights(kFrames, kExpressions)), turns());
  const auto found = [&](int threads) {
    const Context context = Context().with_threads(threads);
    const JointFit fit(model.neutral(), model, all_triangles(model.triangles()), {}, context);
    return fit(moved, std::vector<RigidTransform>(kFrames), context);
  };
  const HeadAndExpressions one = found(1), three = found(3);
  EXPECT_TRUE(one.weights == three.weights);
  for (int f = 0; f < kFrames; ++f) {
    EXPECT_TRUE(one.motion[f].rotation == three.motion[f].rotation);
    EXPECT_TRUE(one.motion[f].translation == three.motion[f].translation);
  }
}

TEST(JointFit, RefusesWhatDoesNotFit) {
  const BlendshapeModel model = moving_everywhere();
  const JointFit fit(model.neutral(), model, all_triangles(model.triangles()));
  EXPECT_THROW(fit(model.animate(test::random_weights(kFrames, kExpressions)), {}), MismatchError);
  EXPECT_THROW(JointFit(Positions::Zero(4, 3), model, {0}), MismatchError);
}

}  // namespace
}  // namespace mimetra
