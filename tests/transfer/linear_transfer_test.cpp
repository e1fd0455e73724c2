#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/linear_transfer.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kRigFrames = 40, kRigExpressions = 5;

/// Rigs of one topology and two identities.
class LinearTransferTest : public testing::Test {
 protected:
  const BlendshapeModel source_ = test::model_on(test::patch(), kRigExpressions);
  const BlendshapeModel target_ = test::model_on(test::bent_patch(), kRigExpressions);
  const std::vector<int> all_ = all_triangles(target_.triangles());
  const Eigen::MatrixXd weights_ = test::random_weights(kRigFrames, kRigExpressions);
  const Eigen::VectorXd times_ = Eigen::VectorXd::LinSpaced(kRigFrames, 0, 1);

  Animation take(const Eigen::MatrixXd& weights) const {
    return {std::make_shared<const BlendshapeModel>(source_), weights, times_};
  }
  /// The right-hand side of eq. 11 at some weights of the source.
  static Eigen::VectorXd right_hand_side(const BlendshapeTransfer& transfer,
                                         const BlendshapeModel& source, const Eigen::VectorXd& w) {
    return transfer.right_hand_side(source.pose(w));
  }
};

TEST(TriangleFrameChange, IsTheDerivativeOfTheFrame) {
  const Eigen::Vector3d a(0.2, -0.1, 0.4), b(1.3, 0.2, 0.1), c(0.1, 0.9, -0.3);
  const Eigen::Vector3d da(0.3, 0.1, -0.7), db(-0.2, 0.5, 0.4), dc(0.6, -0.3, 0.2);
  Edges edges, change;
  edges << b - a, c - a;
  change << db - da, dc - da;
  // A central difference errs by h^2 of the third derivative, a few units, and by rounding / h.
  const double h = 1e-5;
  const Eigen::Matrix3d expected = (triangle_frame(a + h * da, b + h * db, c + h * dc) -
                                    triangle_frame(a - h * da, b - h * db, c - h * dc)) /
                                   (2 * h);
  EXPECT_LE((triangle_frame_change(edges, change) - expected).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(TriangleFrameChange, HasNoNormalWhereThereIsNoArea) {
  Edges edges, change;
  edges << Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(2, 0, 0);
  change << Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1);
  EXPECT_TRUE(triangle_frame_change(edges, change).col(2).isZero(0));
}

TEST_F(LinearTransferTest, IsTheDerivativeOfTheTransferAtTheNeutral) {
  for (const EdgeSum edges : {EdgeSum::all, EdgeSum::two}) {
    const BlendshapeTransfer transfer(source_.neutral(), target_,
                                      test::half_of(target_.triangles()), {.edges = edges});
    const Retargeting map =
        linear_transfer(source_, target_, test::half_of(target_.triangles()), {.edges = edges});
    EXPECT_TRUE(map.gram == transfer.gram());
    const double h = 1e-4;
    for (int j = 0; j < kRigExpressions; ++j) {
      const Eigen::VectorXd w = h * Eigen::VectorXd::Unit(kRigExpressions, j);
      const Eigen::VectorXd expected =
          (right_hand_side(transfer, source_, w) - right_hand_side(transfer, source_, -w)) /
          (2 * h);
      // h^2 of a third derivative that is of the size of the first.
      EXPECT_LE((map.linear.col(j) - expected).norm(), 1e-6 * expected.norm()) << j;
    }
  }
}

TEST_F(LinearTransferTest, ErrsBySquareOfTheAmplitude) {
  const BlendshapeTransfer transfer(source_.neutral(), target_, all_);
  const Retargeting map = linear_transfer(source_, target_, all_);
  const Eigen::VectorXd w = weights_.row(3).transpose();
  const auto error = [&](double amplitude) {
    return (right_hand_side(transfer, source_, amplitude * w) - map.linear * (amplitude * w))
        .norm();
  };
  // Each half leaves a quarter, up to the share of the cubes, an amplitude's.
  for (const double amplitude : {0.02, 0.01, 0.005}) {
    EXPECT_NEAR(error(amplitude) / error(amplitude / 2), 4, 40 * amplitude);
  }
}

TEST_F(LinearTransferTest, IsExactOntoItself) {
  // Q_i V_i are the pose's own edges there: the normal has no part, and H = G.
  const Retargeting map = linear_transfer(source_, source_, all_);
  EXPECT_LE((map.linear - map.gram).cwiseAbs().maxCoeff(), 1e-12 * map.gram.cwiseAbs().maxCoeff());
  // The condition number of these bumps is below 100.
  EXPECT_LE(difference_of(retargeted(map, weights_, times_), weights_).largest, 1e-10);
}

TEST_F(LinearTransferTest, TakesRidgeSparsityAndSmoothnessAsTheTransferDoes) {
  for (const BlendshapeTransferOptions& options :
       {BlendshapeTransferOptions{.ridge = 0.1}, BlendshapeTransferOptions{.sparsity = 0.1},
        BlendshapeTransferOptions{.ridge = 0.05, .smoothness = 0.05}}) {
    const BlendshapeTransfer transfer(source_.neutral(), source_, all_, options);
    const Retargeting map = linear_transfer(source_, source_, all_);
    EXPECT_LE(
        difference_of(retargeted(map, weights_, times_, options), transfer.weights(take(weights_)))
            .largest,
        1e-9);
  }
}

TEST_F(LinearTransferTest, SolvesTheBoxOfEveryFrame) {
  const Retargeting map = linear_transfer(source_, target_, all_);
  const Eigen::MatrixXd beta = retargeted(map, 2 * weights_, times_);
  int at_bounds = 0;
  for (int f = 0; f < kRigFrames; ++f) {
    const Eigen::VectorXd h = map.linear * (2 * weights_.row(f).transpose());
    EXPECT_LE(box_optimality_violation(map.gram, h, map.lower, map.upper, beta.row(f).transpose()),
              1e-12);
    at_bounds += static_cast<int>((beta.row(f).array() == 1).count());
  }
  EXPECT_GT(at_bounds, 0);
}

TEST_F(LinearTransferTest, IsSmoothWithinAnyBounds) {
  Retargeting map = linear_transfer(source_, target_, all_);
  map.lower << -0.3, 0, 0.1, 0.4, 0;
  map.upper << 1.5, 0.5, 0.6, 0.4, 1;
  const BlendshapeTransferOptions options{.smoothness = 0.05};
  Eigen::MatrixXd weights = 2 * weights_;
  weights.col(0) *= -1;
  const Eigen::MatrixXd beta = retargeted(map, weights, times_, options);
  const WeightBounds bounds{map.lower.transpose().replicate(kRigFrames, 1),
                            map.upper.transpose().replicate(kRigFrames, 1)};
  const std::vector<Eigen::Index> free = map.free();
  ASSERT_EQ(free.size(), 4U);
  const double mu =
      smoothness_penalty(options.smoothness, times_, map.gram.diagonal()(free).mean());
  const Eigen::MatrixXd h = weights * map.linear.transpose();
  EXPECT_LE(smooth_optimality_violation({map.gram}, h, times_, mu, beta, bounds), 1e-9);
  EXPECT_TRUE((beta.col(3).array() == 0.4).all());
  EXPECT_LT(beta.col(0).minCoeff(), 0);
  EXPECT_EQ(beta.col(1).maxCoeff(), 0.5);
}

TEST_F(LinearTransferTest, IsEqualBytesForEveryNumberOfThreads) {
  const Context alone = Context().with_threads(1);
  const Retargeting one = linear_transfer(source_, target_, all_, {}, alone);
  const Eigen::MatrixXd weights = retargeted(one, weights_, times_, {}, alone);
  for (const int threads : {2, 3, 8}) {
    const Context context = Context().with_threads(threads);
    const Retargeting map = linear_transfer(source_, target_, all_, {}, context);
    EXPECT_TRUE(map.linear == one.linear);
    EXPECT_TRUE(retargeted(map, weights_, times_, {}, context) == weights);
  }
}

TEST_F(LinearTransferTest, GoesThroughPairs) {
  const auto trimesh = [](const BlendshapeModel& model) {
    return TriMesh{model.neutral(), model.connectivity()};
  };
  // Each triangle of the target takes half of its own partner and half of the next.
  Correspondence pairs;
  pairs.source_triangles = static_cast<int>(source_.triangles().rows());
  for (int t = 0; t < target_.triangles().rows(); ++t) {
    const int partner = std::min<int>(t, pairs.source_triangles - 2);
    pairs.parts.push_back({partner, 0.5});
    pairs.parts.push_back({partner + 1, 0.5});
    pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
  }
  pairs.residuals = Eigen::VectorXd::Zero(target_.triangles().rows());
  const BlendshapeTransferOptions options{
      .pairing =
          std::make_shared<const Pairing>(trimesh(source_), trimesh(target_), std::move(pairs))};
  const BlendshapeTransfer transfer(source_.neutral(), target_, all_, options);
  const Retargeting map = linear_transfer(source_, target_, all_, options);
  const double h = 1e-4;
  const Eigen::VectorXd w = h * Eigen::VectorXd::Ones(kRigExpressions);
  const Eigen::VectorXd expected =
      (right_hand_side(transfer, source_, w) - right_hand_side(transfer, source_, -w)) / (2 * h);
  EXPECT_LE((map.linear * (w / h) - expected).norm(), 1e-6 * expected.norm());
}

TEST_F(LinearTransferTest, HoldsWhatTheTrianglesDoNotShowAt0) {
  // The triangles around the middle of the first bump do not reach all of the others.
  std::vector<int> few;
  for (const int t : all_) {
    if ((target_.triangles().row(t).array() == 20).any()) few.push_back(t);
  }
  const Retargeting map = linear_transfer(source_, target_, few);
  const BlendshapeTransfer transfer(source_.neutral(), target_, few);
  std::vector<std::string> held;
  for (int j = 0; j < kRigExpressions; ++j) {
    if (map.upper[j] == 0) held.push_back(map.target_names[j]);
  }
  EXPECT_FALSE(held.empty());
  EXPECT_EQ(held, transfer.conditions().unseen);
  const Eigen::MatrixXd beta = retargeted(map, weights_, times_);
  const Eigen::MatrixXd plain = plain_matrix(map);
  for (int j = 0; j < kRigExpressions; ++j) {
    if (map.upper[j] > 0) continue;
    EXPECT_TRUE(beta.col(j).isZero(0));
    EXPECT_TRUE(plain.row(j).isZero(0));
  }
}

TEST_F(LinearTransferTest, RefusesWhatItCannotMean) {
  const BlendshapeModel mesh(source_.shared_connectivity(), source_.neutral(), {{}, {}});
  EXPECT_THAT(test::message_of<MismatchError>([&] { linear_transfer(mesh, target_, all_); }),
              HasSubstr("the source has no expressions"));
  EXPECT_THAT(test::message_of<MismatchError>([&] { linear_transfer(source_, mesh, all_); }),
              HasSubstr("the target has no expressions"));
  Retargeting map = linear_transfer(source_, target_, all_);
  EXPECT_THAT(test::message_of<std::invalid_argument>(
                  [&] { retargeted(map, Eigen::MatrixXd::Zero(2, 3), times_); }),
              HasSubstr("3 weights a frame for a source of 5 expressions"));
  map.lower[2] = -0.5;
  EXPECT_THAT(test::message_of<MismatchError>(
                  [&] { retargeted(map, weights_, times_, {.sparsity = 0.1}); }),
              HasSubstr("'shape2' may be negative"));
}

}  // namespace
}  // namespace mimetra
