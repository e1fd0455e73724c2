#include "toolkit/transfer/local_weights.h"

#include <gmock/gmock.h>

#include "tests/cache_sizes.h"
#include "tests/streams.h"
#include "tests/transfer/faces.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A performance of one patch, whose two ends do different things, and a bent one that follows.
class LocalWeightsTest : public testing::Test {
 protected:
  static constexpr int kExpressions = 5, kFrames = 20;

  /// Three columns that fade into each other along x.
  RegionShares thirds() const {
    Eigen::MatrixXd shares(actor_.vertices(), 3);
    for (int v = 0; v < shares.rows(); ++v) {
      const double x = test::patch().positions(v, 0) / 8;
      const double left = std::clamp(1 - 2.5 * x, 0.0, 1.0);
      const double right = std::clamp(2.5 * x - 1.5, 0.0, 1.0);
      shares.row(v) << left, right, 1 - left - right;
    }
    return shares.sparseView(1, 0);
  }

  BlendshapeTransfer whole() const { return {source_.rest(), actor_, all_}; }
  LocalWeights local(const LocalWeightsOptions& options = {}, const Context& context = {}) const {
    return {source_.rest(), actor_, shares_, all_, options, context};
  }
  RegionalAnimation animated(const RegionalWeights& weights) const {
    return {std::make_shared<const BlendshapeModel>(actor_), shares_, weights.beta};
  }
  double error_of(const FrameSource& result) const {
    return transfer_error(source_, result, all_).de_all;
  }

  /// The model whose expressions are the products of shares and fields, one after the other.
  BlendshapeModel literal() const {
    const Eigen::MatrixXd shares = shares_;
    ShapeBasis basis{{}, Eigen::MatrixXd(3 * actor_.vertices(), shares.cols() * kExpressions)};
    for (int r = 0; r < shares.cols(); ++r) {
      for (int j = 0; j < kExpressions; ++j) {
        const int column = r * kExpressions + j;
        basis.names.push_back(std::to_string(column));
        for (int row = 0; row < 3 * actor_.vertices(); ++row) {
          basis.displacements(row, column) =
              shares(row / 3, r) * actor_.expressions().displacements(row, j);
        }
      }
    }
    return {actor_.shared_connectivity(), actor_.neutral(), basis};
  }

  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), kExpressions);
  const MeshSequence source_ = test::shaken(test::patch(), kFrames, 0.1);
  const std::vector<int> all_ = all_triangles(actor_.triangles());
  RegionShares shares_ = thirds();
};

TEST_F(LocalWeightsTest, IsTheLiteralProblemOfAModelWithMoreExpressions) {
  for (const EdgeSum edges : {EdgeSum::all, EdgeSum::two}) {
    for (const std::vector<int>& triangles : {all_, test::half_of(actor_.triangles())}) {
      const BlendshapeTransfer dense(source_.rest(), literal(), triangles, {.edges = edges});
      const LocalWeights fast(source_.rest(), actor_, shares_, triangles, {.edges = edges});
      // Both are sums of the same products in another order.
      const double size = dense.gram().cwiseAbs().maxCoeff();
      EXPECT_LT((fast.gram() - dense.gram()).cwiseAbs().maxCoeff(), 1e-13 * size);
      for (int f = 0; f < kFrames; f += 7) {
        const Eigen::VectorXd h = dense.right_hand_side(source_.frame(f));
        EXPECT_LT((fast.right_hand_side(source_.frame(f)) - h).lpNorm<Eigen::Infinity>(),
                  1e-12 * h.lpNorm<Eigen::Infinity>());
      }
    }
  }
}

TEST_F(LocalWeightsTest, AreTheMinimumOfTheJointProblem) {
  const Eigen::MatrixXd global = whole().weights(source_);
  const LocalWeights local = this->local();
  const RegionalWeights found = local.weights(source_, global);
  Eigen::MatrixXd system = local.gram();
  system.diagonal() += local.pull();
  const Eigen::Index unknowns = system.rows();
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(unknowns);
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(unknowns);
  int at_bounds = 0;
  for (int f = 0; f < kFrames; ++f) {
    const Eigen::VectorXd h = local.right_hand_side(source_.frame(f)) +
                              local.pull().cwiseProduct(global.row(f).transpose().replicate(3, 1));
    Eigen::VectorXd expected = box_least_squares(system, h, lower, upper);
    const Eigen::VectorXd beta = found.beta.row(f).transpose();
    // An expression that does not move in a region has the weight of the whole face there.
    for (Eigen::Index u = 0; u < unknowns; ++u) {
      if (local.pull()[u] == 0) expected[u] = global(f, u % kExpressions);
    }
    // The system's condition number, which the ridge keeps below 100, times rounding.
    EXPECT_LT((beta - expected).lpNorm<Eigen::Infinity>(), 1e-11) << f;
    EXPECT_LT(box_optimality_violation(system, h, lower, upper, beta), 1e-12) << f;
    at_bounds += (beta.array() == 0).count() + (beta.array() == 1).count();
  }
  EXPECT_LT(found.violation, 1e-12);
  EXPECT_GT(at_bounds, kFrames);
}

TEST_F(LocalWeightsTest, FollowWhatTheWholeFaceCannot) {
  const Eigen::MatrixXd global = whole().weights(source_);
  const double of_whole = error_of(actor_.animate(global));
  double before = 0;
  // Less ridge, less error: the minimum over more freedom.
  for (const double ridge : {1e-6, 1e-2, 1.0, 100.0}) {
    const double error = error_of(animated(local({.ridge = ridge}).weights(source_, global)));
    EXPECT_GE(error, before * (1 - 1e-12)) << ridge;
    EXPECT_LE(error, of_whole * (1 + 1e-12)) << ridge;
    before = error;
  }
}

TEST_F(LocalWeightsTest, AreThoseOfTheWholeFaceWhereTheRidgeHoldsThem) {
  const Eigen::MatrixXd global = whole().weights(source_);
  // The pull outweighs the Gram matrix by 1e12.
  const RegionalWeights found = local({.ridge = 1e12}).weights(source_, global);
  EXPECT_LT((found.beta - global.replicate(1, 3)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(LocalWeightsTest, AreThoseOfTheWholeFaceWhereOneRegionIsAllOfIt) {
  const Eigen::MatrixXd global = whole().weights(source_);
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(actor_.vertices(), 2);
  for (const int everywhere : {0, 1}) {
    shares.setZero();
    shares.col(everywhere).setOnes();
    shares_ = shares.sparseView(1, 0);
    const RegionalWeights found = local().weights(source_, global);
    // The region that is nowhere sees nothing, and has the whole face's bit by bit.
    EXPECT_TRUE(found.beta.middleCols((1 - everywhere) * kExpressions, kExpressions) == global);
    EXPECT_LT((found.beta - global.replicate(1, 2)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_F(LocalWeightsTest, DoNotCoupleRegionsWithoutACommonTriangle) {
  const Eigen::MatrixXd gram = local().gram();
  EXPECT_TRUE(gram.block(0, kExpressions, kExpressions, kExpressions).isZero(0));
  EXPECT_FALSE(gram.block(0, 2 * kExpressions, kExpressions, kExpressions).isZero(1e-3));
  EXPECT_TRUE(gram == gram.transpose());
}

TEST_F(LocalWeightsTest, AreExactlyZeroAtRest) {
  const Frames at_rest =
      source_.rest().reshaped<Eigen::RowMajor>().transpose().replicate(kFrames, 1);
  const MeshSequence still = source_.with_frames(at_rest);
  EXPECT_TRUE(local().weights(still, Eigen::MatrixXd::Zero(kFrames, kExpressions)).beta.isZero(0));
}

TEST_F(LocalWeightsTest, AreTheSameBytesForAnyThreadsStreamsAndProcessors) {
  const Eigen::MatrixXd global = whole().weights(source_);
  const Context alone = Context().with_threads(1);
  const LocalWeights by_one = local({}, alone);
  const Eigen::MatrixXd one = by_one.weights(source_, global, alone).beta;
  for (const int threads : {2, 3}) {
    const Context context = Context().with_threads(threads);
    const LocalWeights by_several = local({}, context);
    EXPECT_TRUE(by_several.gram() == by_one.gram());
    EXPECT_TRUE(by_several.weights(source_, global, context).beta == one);
  }
  EXPECT_TRUE(local().weights(test::Stream(source_), global).beta == one);
  test::expect_equal_bytes_on_each_processor([&] { return local().weights(source_, global).beta; });
}

TEST_F(LocalWeightsTest, RefusesWhatDoesNotFit) {
  const Eigen::MatrixXd global = whole().weights(source_);
  EXPECT_THAT([&] { local({.ridge = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("ridge is 0; it must be at least")));
  EXPECT_THAT([&] { local().weights(source_, global.leftCols(4)); },
              ThrowsMessage<MismatchError>(HasSubstr("weights of the whole face")));
  const Positions fewer = source_.rest().topRows(40);
  EXPECT_THAT([&] { local().right_hand_side(fewer); },
              ThrowsMessage<MismatchError>(HasSubstr("40 vertices, the rest pose 81")));
  EXPECT_THAT(
      [&] { LocalWeights(source_.rest(), test::model_on(test::bent_patch(), 0), shares_, all_); },
      ThrowsMessage<MismatchError>(HasSubstr("no expressions")));
  shares_ = shares_.topRows(80);
  EXPECT_THAT([&] { local(); }, ThrowsMessage<std::invalid_argument>(HasSubstr("80 vertices")));
}

}  // namespace
}  // namespace mimetra
