#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/takes.h"
#include "tests/temporary_folder.h"
#include "toolkit/pipeline/retarget.h"
#include "toolkit/transfer/linear_transfer.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

constexpr int kDrivenFrames = 30, kDrivenExpressions = 5;

/// The model in another unit, turned and shifted.
BlendshapeModel moved_rig(const BlendshapeModel& model) {
  const Eigen::Matrix3d turn =
      40 * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  Positions neutral = model.neutral() * turn.transpose();
  neutral.rowwise() += Eigen::RowVector3d(100, -50, 7);
  ShapeBasis shapes = model.expressions();
  for (int j = 0; j < shapes.size(); ++j) {
    Eigen::Map<Positions> field(shapes.displacements.col(j).data(), model.vertices(), 3);
    const Positions turned = field * turn.transpose();
    field = turned;
  }
  return {model.shared_connectivity(), std::move(neutral), std::move(shapes)};
}

class RetargetTest : public testing::Test {
 protected:
  Animation take(double amplitude) const {
    return {std::make_shared<const BlendshapeModel>(source_), amplitude * weights_};
  }
  static Eigen::MatrixXd by_map(const RetargetResult& result, const Animation& source) {
    return retargeted(*result.map, source.weights(), source.times());
  }

  const BlendshapeModel source_ = test::model_on(test::patch(), kDrivenExpressions);
  const BlendshapeModel other_ = test::model_on(test::bent_patch(), kDrivenExpressions);
  const Eigen::MatrixXd weights_ = test::random_weights(kDrivenFrames, kDrivenExpressions);
};

TEST_F(RetargetTest, OntoItselfGivesTheWeightsWhereverItStands) {
  const BlendshapeModel moved = moved_rig(source_);
  for (const BlendshapeModel* target : {&source_, &moved}) {
    const RetargetResult result = retarget(take(1), Target{"target", *target}, {.keep_map = true});
    // The condition number of these bumps is below 100, that of the similarity 1.
    EXPECT_LE(difference_of(result.transferred.solution.weights(), weights_).largest, 1e-10);
    EXPECT_LE(difference_of(by_map(result, take(1)), weights_).largest, 1e-10);
  }
}

TEST_F(RetargetTest, KeepsAMapThatIsRightWhereWeightsAreSmall) {
  const BlendshapeModel target = moved_rig(other_);
  const auto error = [&](double amplitude) {
    const Animation source = take(amplitude);
    const RetargetResult result = retarget(source, Target{"target", target}, {.keep_map = true});
    return difference_of(by_map(result, source), result.transferred.solution.weights()).largest;
  };
  // It falls with the square of the amplitude.
  EXPECT_GT(error(1), 0);
  EXPECT_LE(error(0.1), 0.02 * error(1));
  EXPECT_LE(error(1), 0.1);
}

TEST_F(RetargetTest, KeepsNoMapThatNobodyAskedFor) {
  EXPECT_FALSE(retarget(take(1), Target{"target", other_}).map);
}

TEST_F(RetargetTest, KeepsItsMapOverPairs) {
  const Correspondence same =
      Correspondence::identity(static_cast<int>(source_.triangles().rows()));
  const RetargetResult plain = retarget(take(1), Target{"target", other_}, {.keep_map = true});
  const RetargetResult paired =
      retarget(take(1), Target{"target", other_, same}, {.keep_map = true});
  EXPECT_TRUE(paired.transferred.solution.weights() == plain.transferred.solution.weights());
  EXPECT_TRUE(paired.map->linear == plain.map->linear);
}

TEST_F(RetargetTest, IsEqualBytesForEveryNumberOfThreads) {
  const RetargetResult one =
      retarget(take(1), Target{"target", other_}, {.keep_map = true}, Context().with_threads(1));
  for (const int threads : {2, 5}) {
    const RetargetResult result = retarget(take(1), Target{"target", other_}, {.keep_map = true},
                                           Context().with_threads(threads));
    EXPECT_TRUE(result.transferred.solution.weights() == one.transferred.solution.weights());
    EXPECT_TRUE(result.map->linear == one.map->linear);
    EXPECT_TRUE(result.map->gram == one.map->gram);
  }
}

TEST_F(RetargetTest, NeedsExpressionsOnBothSides) {
  const BlendshapeModel mesh(source_.shared_connectivity(), source_.neutral(), {{}, {}});
  const Animation still(std::make_shared<const BlendshapeModel>(mesh), Eigen::MatrixXd(2, 0));
  EXPECT_THAT(test::message_of<MismatchError>([&] {
                retarget(still, Target{"target", other_}, {.source_name = "scan"});
              }),
              HasSubstr("scan: has no expressions"));
  EXPECT_THAT(test::message_of<MismatchError>([&] {
                retarget(take(1), Target{"bust", mesh});
              }),
              HasSubstr("bust: has no expressions"));
}

}  // namespace
}  // namespace mimetra
