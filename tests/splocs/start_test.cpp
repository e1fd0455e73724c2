#include "toolkit/splocs/start.h"

#include <gmock/gmock.h>

#include "tests/splocs/synthetic.h"

namespace mimetra::test {
namespace {

/// Weights that rise in 10 of 100 frames and carry noise below zero in the others.
Eigen::VectorXd pulse_with_noise() {
  Eigen::VectorXd w = Eigen::VectorXd::Constant(100, -1e-12);
  for (int f = 0; f < 10; ++f) w[40 + f] = 1 - 0.1 * f;
  return w;
}

TEST(SignRule, AmplitudePrefersTheMotionToTheNoise) {
  EXPECT_GT(oriented_weights(pulse_with_noise(), SignRule::amplitude, true)[40], 0);
}

TEST(SignRule, LiteralPrefersTheNoise) {
  // Divided by its maximum, the noise has norm sqrt(90) against less than sqrt(10).
  EXPECT_EQ(oriented_weights(pulse_with_noise(), SignRule::literal, true)[40], 0);
}

TEST(SignRule, DoesNotDependOnTheSignGiven) {
  const Eigen::VectorXd w = pulse_with_noise();
  for (const SignRule rule : {SignRule::amplitude, SignRule::literal}) {
    EXPECT_EQ(oriented_weights(w, rule, true), oriented_weights(-w, rule, true));
  }
  EXPECT_EQ(oriented_weights(w, SignRule::literal, false),
            oriented_weights(-w, SignRule::literal, false));
}

TEST(SignRule, AmplitudeTellsEqualSignsApartByTime) {
  Eigen::VectorXd w(6);
  w << 0, 0.4, -1, 1, -0.4, 0;
  const Eigen::VectorXd expected = (Eigen::VectorXd(6) << 0, 0, 1, 0, 0.4, 0).finished();
  EXPECT_EQ(oriented_weights(w, SignRule::amplitude, true), expected);
  EXPECT_EQ(oriented_weights(-w, SignRule::amplitude, true), expected);
}

/// Support maps of radius 5: each holds a whole bump, and nothing of the next one.
SupportFunction around_one_bump(const Bumps& bumps) {
  return support_function(one_by_one(straight_distances(bumps.shape.positions)),
                          static_cast<int>(bumps.shape.positions.rows()), 5, 5.5);
}

TEST(GreedyStart, ExplainsDisjointBumpsCompletely) {
  const Bumps bumps;
  DecompositionOptions options;
  options.count = 3;
  const Frames X = bumps.W * bumps.C;
  const Start start = greedy_start(VertexBlocks<double>(X), around_one_bump(bumps), options);
  EXPECT_LT((X - start.weights * start.components.frames()).norm(), 1e-13 * X.norm());
}

TEST(GreedyStart, TakesTheStrongestVertexOfWhatIsLeft) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options;
  options.count = 8;
  const SupportFunction support =
      support_function(one_by_one(straight_distances(sequence.rest())), sequence.vertices(), 1, 6);
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  Frames residual = sequence.positions().rowwise() - rest;
  const Start start = greedy_start(VertexBlocks<double>(residual), support, options);
  const Frames C = start.components.frames();
  for (int k = 0; k < options.count; ++k) {
    Eigen::VectorXd energies = Eigen::VectorXd::Zero(sequence.vertices());
    for (const auto& frame : residual.rowwise()) energies += vertex_energies(frame);
    EXPECT_EQ(start.centers[k], strongest_vertex(energies));
    residual -= start.weights.col(k) * C.row(k);
  }
}

TEST(GreedyStart, StopsWhereNothingIsLeft) {
  const Bumps bumps;
  DecompositionOptions options;
  options.count = 5;
  const Start start =
      greedy_start(VertexBlocks<double>(bumps.W * bumps.C), around_one_bump(bumps), options);
  EXPECT_THAT(std::vector(start.centers.begin() + 3, start.centers.end()), testing::Each(-1));
  EXPECT_TRUE(start.components.frames().bottomRows(2).isZero(0));
  EXPECT_TRUE(start.weights.rightCols(2).isZero(0));
}

TEST(StrongestVertex, IsTheLowestOfEquals) {
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3, 2)), 1);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3 * (1 + 1e-12), 2)), 1);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3 * (1 + 1e-8), 2)), 2);
}

TEST(StrongestVertex, IsNoneWhereNothingMoves) {
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d::Zero()), -1);
}

}  // namespace
}  // namespace mimetra::test
