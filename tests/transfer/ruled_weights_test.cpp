#include <gmock/gmock.h>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/transfer/blendshape_transfer.h"

namespace mimetra {
namespace {

using test::model_on;
using test::random_weights;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A performance of one face on another, both of the expressions `names`.
class RuledWeightsTest : public testing::Test {
 protected:
  static BlendshapeModel with_names(const test::Shape& shape) {
    ShapeBasis basis = test::bumps(shape.positions, 5);
    basis.names = {"smile_L", "smile_R", "eyeLookUp_L", "eyeLookDown_L", "jawOpen"};
    return {test::connectivity_of(shape), shape.positions, basis};
  }

  Eigen::MatrixXd weights(const BlendshapeTransferOptions& options,
                          const Context& context = {}) const {
    return transfer(options).weights(take_, context);
  }

  BlendshapeTransfer transfer(const BlendshapeTransferOptions& options) const {
    return {take_.rest(), target_, all_triangles(target_.triangles()), options};
  }

  /// beta^T G beta / 2 - h^T beta of a frame.
  double energy(const Eigen::VectorXd& beta, int frame) const {
    const Eigen::VectorXd h = plain_.right_hand_side(take_.frame(frame));
    return beta.dot(plain_.gram() * beta) / 2 - h.dot(beta);
  }

  const MeshSequence take_ = model_on(test::patch(), 5).animate(random_weights(20, 5));
  const BlendshapeModel target_ = with_names(test::bent_patch());
  const BlendshapeTransfer plain_ = transfer({});
};

TEST_F(RuledWeightsTest, AreThoseWithoutRulesWhereThereAreNone) {
  const Eigen::MatrixXd plain = weights({});
  EXPECT_EQ(weights({.rules = {.name = "empty"}}), plain);
  BlendshapeTransferOptions usual;
  usual.rules.expressions["jawOpen"] = {};
  EXPECT_EQ(weights(usual), plain);
}

TEST_F(RuledWeightsTest, AreTheBestUnderSymmetry) {
  const double symmetry = 3;
  Eigen::MatrixXd gram = plain_.gram();
  const double pair = symmetry * gram.diagonal().mean();
  gram.topLeftCorner<2, 2>() += pair * Eigen::Matrix2d{{1, -1}, {-1, 1}};
  const Eigen::MatrixXd beta = weights({.symmetry = symmetry});
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(5), one = Eigen::VectorXd::Ones(5);
  for (int f = 0; f < take_.frames(); ++f) {
    const Eigen::VectorXd h = plain_.right_hand_side(take_.frame(f));
    // As in the box alone: rounding times the condition number.
    EXPECT_LT(box_optimality_violation(gram, h, zero, one, beta.row(f).transpose()), 1e-10);
  }
  EXPECT_LT((beta.col(0) - beta.col(1)).norm(),
            0.5 * (weights({}).col(0) - weights({}).col(1)).norm());
}

TEST_F(RuledWeightsTest, HaveOneLookAtMostAndTheBetterOne) {
  const Eigen::MatrixXd free = weights({}), ruled = weights({.exclusive = Exclusive::eyes});
  std::vector<Eigen::MatrixXd> one_held;
  for (const char* held : {"eyeLookUp_L", "eyeLookDown_L"}) {
    BlendshapeTransferOptions one;
    one.rules.expressions[held] = {.maximum = 0};
    one_held.push_back(weights(one));
  }
  int both = 0;
  for (int f = 0; f < take_.frames(); ++f) {
    both += free(f, 2) > 0 && free(f, 3) > 0;
    EXPECT_TRUE(ruled(f, 2) == 0 || ruled(f, 3) == 0) << f;
    const double found = energy(ruled.row(f).transpose(), f);
    for (const Eigen::MatrixXd& beta : one_held) {
      const double other = energy(beta.row(f).transpose(), f);
      EXPECT_LE(found, other + 1e-12 * std::abs(other)) << f;
    }
  }
  EXPECT_GT(both, 0);
}

TEST_F(RuledWeightsTest, AreBoundedAsTheyAreWritten) {
  BlendshapeTransferOptions options;
  options.rules.expressions["jawOpen"] = {
      .minimum = 0.1, .maximum = 0.7, .gain = 1.5, .offset = 0.05};
  const Eigen::MatrixXd written = weights(options);
  EXPECT_EQ(written.col(4).minCoeff(), 0.1);
  EXPECT_EQ(written.col(4).maxCoeff(), 0.7);
  Eigen::VectorXd lower = Eigen::VectorXd::Zero(5), upper = Eigen::VectorXd::Ones(5);
  lower[4] = (0.1 - 0.05) / 1.5;
  upper[4] = (0.7 - 0.05) / 1.5;
  for (int f = 0; f < take_.frames(); ++f) {
    Eigen::VectorXd beta = written.row(f).transpose();
    beta[4] = std::clamp((beta[4] - 0.05) / 1.5, lower[4], upper[4]);
    const Eigen::VectorXd h = plain_.right_hand_side(take_.frame(f));
    EXPECT_LT(box_optimality_violation(plain_.gram(), h, lower, upper, beta), 1e-10) << f;
  }
}

TEST_F(RuledWeightsTest, KeepRulesWithSmoothness) {
  BlendshapeTransferOptions options{.smoothness = 0.1, .exclusive = Exclusive::eyes};
  options.rules.expressions["jawOpen"] = {.maximum = 0.6};
  const Eigen::MatrixXd beta = weights(options);
  EXPECT_LE(beta.col(4).maxCoeff(), 0.6);
  for (int f = 0; f < take_.frames(); ++f) EXPECT_TRUE(beta(f, 2) == 0 || beta(f, 3) == 0) << f;
}

TEST_F(RuledWeightsTest, AreTheSameBytesForAnyThreads) {
  BlendshapeTransferOptions options{.symmetry = 1, .exclusive = Exclusive::eyes};
  options.rules.exclusive = {{"jawOpen", "smile_L", "smile_R"}};
  const Eigen::MatrixXd one = weights(options, Context().with_threads(1));
  EXPECT_EQ(weights(options, Context().with_threads(3)), one);
}

TEST_F(RuledWeightsTest, LeaveOutPairsOfWhichOneIsNotSeen) {
  ShapeBasis basis = target_.expressions();
  basis.displacements.col(1).setZero();
  const BlendshapeModel half(target_.shared_connectivity(), target_.neutral(), basis);
  const auto of = [&](double symmetry) {
    return BlendshapeTransfer(take_.rest(), half, all_triangles(half.triangles()),
                              {.symmetry = symmetry})
        .weights(take_);
  };
  EXPECT_EQ(of(5), of(0));
}

TEST_F(RuledWeightsTest, RefuseSparsityOfWeightsThatMayBeNegative) {
  BlendshapeTransferOptions options{.sparsity = 0.1};
  options.rules = {.name = "r.json"};
  options.rules.expressions["jawOpen"] = {.minimum = -1};
  EXPECT_THAT([&] { transfer(options); },
              ThrowsMessage<MismatchError>(HasSubstr("r.json: 'jawOpen' may be negative")));
}

}  // namespace
}  // namespace mimetra
