#include "toolkit/splocs/vertex_blocks.h"

#include <gtest/gtest.h>

#include "tests/splocs/synthetic.h"
#include "toolkit/splocs/motion.h"

namespace mimetra::test {
namespace {

/// Two whole blocks and a rest.
constexpr Eigen::Index kMany = 2 * VertexPart::kBlock + 5;

TEST(VertexBlocks, ComeTogetherAsTheyWere) {
  for (const Eigen::Index vertices : {Eigen::Index(1), VertexPart::kBlock, kMany}) {
    const Frames rows = Frames::Random(4, 3 * vertices);
    EXPECT_EQ(VertexBlocks<double>(rows).frames(), rows);
  }
}

TEST(VertexBlocks, HoldEveryVertexInEveryRow) {
  const Frames rows = Frames::Random(3, 3 * kMany);
  const VertexBlocks<double> blocks(rows);
  for (VertexIndex v = 0; v < kMany; ++v) {
    EXPECT_EQ(blocks.vertex(v), rows.middleCols(3 * v, 3)) << v;
  }
}

TEST(VertexBlocks, RoundToSinglePrecision) {
  const Frames rows = Frames::Random(3, 3 * kMany);
  const Frames rounded = rows.cast<float>().cast<double>();
  EXPECT_EQ(VertexBlocks<float>(rows).frames(), rounded);
  EXPECT_EQ(VertexBlocks<double>(rows).cast<float>().frames(), rounded);
}

Motion motion_of(const MeshSequence& sequence, MotionScale scale) {
  return scaled_motion({sequence.rest(), sequence.triangles(), sequence}, scale,
                       Reduction(sequence.vertices(), Context().with_threads(2)));
}

Frames frames_of(const Motion& motion) {
  return dynamic_cast<const VertexBlocks<double>&>(*motion.X).frames();
}

TEST(ScaledMotion, IsTheDisplacementOverItsStandardDeviation) {
  const MeshSequence sequence = restless_grid(30, 20, 6);
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  // Far from the rest pose, so that the mean is not small beside what moves.
  const Frames frames = sequence.positions().array() + 1000;
  const Frames X = frames.rowwise() - rest;
  const double deviation = std::sqrt((X.array() - X.mean()).square().mean());
  const Motion motion = motion_of(sequence.with_frames(frames), MotionScale::standard_deviation);
  // Rounding of a mean of 1000 and of coordinates that lost three digits to it.
  EXPECT_NEAR(motion.scale / deviation, 1, 1e-12);
  EXPECT_LT((frames_of(motion) - X / deviation).norm(), 1e-12 * X.norm() / deviation);
  EXPECT_NEAR(motion.norm2 * deviation * deviation / X.squaredNorm(), 1, 1e-12);
}

TEST(ScaledMotion, IsTheDisplacementOverItsRootMeanSquare) {
  const MeshSequence sequence = restless_grid(30, 20, 6);
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  const Frames X = sequence.positions().rowwise() - rest;
  const double rms = std::sqrt(X.array().square().mean());
  const Motion motion = motion_of(sequence, MotionScale::root_mean_square);
  EXPECT_NEAR(motion.scale / rms, 1, 1e-12);
  EXPECT_LT((frames_of(motion) - X / rms).norm(), 1e-12 * X.norm() / rms);
  EXPECT_NEAR(motion.norm2 / static_cast<double>(X.size()), 1, 1e-12);
}

TEST(ScaledMotion, RefusesMotionWhoseEnergyIsNoNumber) {
  const MeshSequence sequence = restless_grid(4, 3, 5);
  EXPECT_THROW(
      motion_of(sequence.with_frames(sequence.positions() * 1e200), MotionScale::root_mean_square),
      std::invalid_argument);
}

}  // namespace
}  // namespace mimetra::test
