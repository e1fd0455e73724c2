#include "toolkit/model/animation.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/model/octahedron.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class RegionalAnimationTest : public testing::Test {
 protected:
  static constexpr int kVertices = 6, kExpressions = 4, kRegions = 3, kFrames = 5;

  Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return uniform_(random_); });
  }

  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  const std::shared_ptr<const BlendshapeModel> model_ = std::make_shared<BlendshapeModel>(
      test::octahedron_connectivity(), test::octahedron().positions,
      ShapeBasis{{"a", "b", "c", "d"}, random_matrix(3 * kVertices, kExpressions)});
  Eigen::MatrixXd shares_ = random_matrix(kVertices, kRegions);
  Eigen::MatrixXd weights_ = random_matrix(kFrames, kRegions* kExpressions);

  RegionalAnimation animation() const { return {model_, shares_.sparseView(), weights_}; }
};

TEST_F(RegionalAnimationTest, IsTheSumOfWhatRegionsDo) {
  const Frames poses = animation().read(0, kFrames);
  const Eigen::MatrixXd& fields = model_->expressions().displacements;
  for (int f = 0; f < kFrames; ++f) {
    for (int v = 0; v < kVertices; ++v) {
      for (int c = 0; c < 3; ++c) {
        double expected = model_->neutral()(v, c);
        for (int r = 0; r < kRegions; ++r) {
          for (int j = 0; j < kExpressions; ++j) {
            expected += shares_(v, r) * weights_(f, r * kExpressions + j) * fields(3 * v + c, j);
          }
        }
        // Sums of twelve numbers of size 1.
        EXPECT_NEAR(poses(f, 3 * v + c), expected, 1e-14);
      }
    }
  }
}

TEST_F(RegionalAnimationTest, IsTheWholeFacesWhereRegionsAgree) {
  for (int v = 0; v < kVertices; ++v) shares_.row(v) /= shares_.row(v).sum();
  const Eigen::MatrixXd global = random_matrix(kFrames, kExpressions);
  weights_ = global.replicate(1, kRegions);
  const Frames expected = Animation(model_, global).read(0, kFrames);
  EXPECT_LT((animation().read(0, kFrames) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_F(RegionalAnimationTest, GivesTheSameNumbersInAnyRun) {
  const RegionalAnimation animation = this->animation();
  const Frames all = animation.read(0, kFrames);
  for (int first = 0; first < kFrames; ++first) {
    EXPECT_TRUE(animation.read(first, kFrames - first) == all.bottomRows(kFrames - first));
    EXPECT_TRUE(animation.read(first, 1) == all.row(first));
  }
}

TEST_F(RegionalAnimationTest, IsTheNeutralWithoutWeightsBitByBit) {
  weights_.setZero();
  EXPECT_TRUE(animation().read(0, 1).row(0) ==
              model_->neutral().reshaped<Eigen::RowMajor>().transpose());
  EXPECT_TRUE(animation().rest() == model_->neutral());
}

TEST_F(RegionalAnimationTest, RefusesOtherSizes) {
  const auto message = [this](const std::string& text) {
    EXPECT_THAT([this] { animation(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  weights_.conservativeResize(kFrames, kRegions * kExpressions - 1);
  message("11 weights for 3 regions and 4 expressions");
  shares_.conservativeResize(kVertices - 1, kRegions);
  message("shares of 5 vertices for a model of 6");
  EXPECT_THAT(
      [this] {
        RegionalAnimation(model_, Eigen::MatrixXd(kVertices, 0).sparseView(),
                          Eigen::MatrixXd(kFrames, 0), Eigen::VectorXd::Zero(2));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("2 times for 5 frames")));
}

}  // namespace
}  // namespace mimetra
