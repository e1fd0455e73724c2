#include <gmock/gmock.h>

#include "tests/samples/head_fixture.h"

namespace mimetra::test {
namespace {

const WeightTrack& performance() {
  static const WeightTrack track = samples::parametric_performance();
  return track;
}

double peak(const std::string& name) {
  return performance().weights.col(head().expressions().find(name)).maxCoeff();
}

TEST(Performance, HasFourSecondsAtThirtyFramesPerSecond) {
  ASSERT_EQ(performance().weights.rows(), 120);
  ASSERT_EQ(performance().times.size(), 120);
  for (int f = 0; f < 120; ++f) EXPECT_DOUBLE_EQ(performance().times[f], f / 30.0);
}

TEST(Performance, DrivesTheExpressionsOfTheHead) {
  EXPECT_EQ(performance().names, head().expressions().names);
}

TEST(Performance, KeepsEveryWeightFromZeroToOne) {
  EXPECT_GE(performance().weights.minCoeff(), 0);
  EXPECT_LE(performance().weights.maxCoeff(), 1);
}

TEST(Performance, BeginsAndEndsNeutral) {
  EXPECT_TRUE(performance().weights.row(0).isZero(0));
  EXPECT_TRUE(performance().weights.row(119).isZero(0));
}

TEST(Performance, UsesEveryExpression) {
  for (const std::string& name : performance().names) EXPECT_GT(peak(name), 0.5) << name;
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
    for (int f = 0; f < 120; f += 5) {
      const Positions pose = person.pose(performance().weights.row(f));
      EXPECT_EQ(flipped(person.neutral(), pose), 0) << "identity " << i << ", frame " << f;
      EXPECT_GT(worst_quality(pose), 1e-3) << "identity " << i << ", frame " << f;
    }
  }
}

}  // namespace
}  // namespace mimetra::test
