#include <gmock/gmock.h>

#include "tests/samples/head_fixture.h"

namespace mimetra::test {
namespace {

const WeightTrack& performance() {
  static const WeightTrack track = samples::parametric_performance();
  return track;
}

TEST(Performance, HasFourSecondsAtThirtyFramesPerSecond) {
  ASSERT_EQ(performance().weights.rows(), 120);
  ASSERT_EQ(performance().times.size(), 120);
  for (int f = 0; f < 120; ++f) EXPECT_DOUBLE_EQ(performance().times[f], f / 30.0);
}

TEST(Performance, DrivesEveryExpressionOfTheHeadFromZeroTowardsOneAndBack) {
  const Eigen::MatrixXd& weights = performance().weights;
  EXPECT_EQ(performance().names, head().expressions().names);
  ASSERT_EQ(weights.cols(), 12);
  EXPECT_GE(weights.minCoeff(), 0);
  EXPECT_LE(weights.maxCoeff(), 1);
  for (int j = 0; j < 12; ++j) EXPECT_GT(weights.col(j).maxCoeff(), 0.5) << j;
  EXPECT_TRUE(weights.row(0).isZero(0));
  EXPECT_TRUE(weights.row(119).isZero(0));
}

TEST(Performance, MovesWithoutJumps) {
  // Three frames, a tenth of a second, are the shortest way from nothing to all: a blink. The
  // smooth step is steepest in its middle, at most 0.5 a frame.
  const Eigen::MatrixXd& weights = performance().weights;
  EXPECT_LE((weights.bottomRows(119) - weights.topRows(119)).cwiseAbs().maxCoeff(), 0.5);
}

TEST(Performance, FlipsAndCrushesNoTriangleOfAnyPerson) {
  for (int i = -1; i < head().identities().size(); ++i) {
    Eigen::VectorXd identity = Eigen::VectorXd::Zero(head().identities().size());
    if (i >= 0) identity[i] = 1;
    const BlendshapeModel person = head().person(identity);
    for (int f = 0; f < 120; f += 5) {  // the first is neutral
      const Positions pose = person.pose(performance().weights.row(f));
      EXPECT_EQ(flipped(person.neutral(), pose), 0) << "identity " << i << ", frame " << f;
      EXPECT_GT(worst_quality(pose), kFewestQuality) << "identity " << i << ", frame " << f;
    }
  }
}

}  // namespace
}  // namespace mimetra::test
