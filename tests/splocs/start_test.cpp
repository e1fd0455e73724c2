#include "toolkit/splocs/start.h"
#include "toolkit/splocs/reduction.h"

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

/// Of the motion of all vertices.
Start start_of(const Frames& X, const SupportFunction& support,
               const DecompositionOptions& options) {
  return greedy_start(VertexBlocks<double>(X), support, options);
}

TEST(GreedyStart, ExplainsDisjointBumpsCompletelyAndStopsWhereNothingIsLeft) {
  const Bumps bumps;
  DecompositionOptions options;
  options.count = 5;
  const Frames X = bumps.W * bumps.C;
  const Start start = start_of(X, around_one_bump(bumps), options);
  EXPECT_LT((X - start.weights * start.components.frames()).norm(), 1e-13 * X.norm());
  EXPECT_THAT(std::vector(start.centers.begin() + 3, start.centers.end()), testing::Each(-1));
  EXPECT_TRUE(start.components.frames().bottomRows(2).isZero(0));
  EXPECT_TRUE(start.weights.rightCols(2).isZero(0));
}

TEST(GreedyStart, TakesTheStrongestVertexOfWhatIsLeft) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options;
  options.count = 8;
  const SupportFunction support =
      support_function(one_by_one(straight_distances(sequence.rest())), sequence.vertices(), 1, 6);
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  Frames residual = sequence.positions().rowwise() - rest;
  const Start start = start_of(residual, support, options);
  const Frames C = start.components.frames();
  for (int k = 0; k < options.count; ++k) {
    Eigen::VectorXd energies = Eigen::VectorXd::Zero(sequence.vertices());
    for (const auto& frame : residual.rowwise()) energies += vertex_energies(frame);
    EXPECT_EQ(start.centers[k], strongest_vertex(energies));
    residual -= start.weights.col(k) * C.row(k);
  }
}

TEST(GreedyStart, LetsASmallPartGoWithAnother) {
  // The bumps as three parts that no way joins; the second moves with the first.
  Bumps bumps;
  bumps.W.col(1) = bumps.W.col(0);
  const auto vertices = static_cast<int>(bumps.shape.positions.rows());
  DecompositionOptions options;
  options.count = 3;
  options.parts.weights = {1, 0.001, 0.5};
  for (int v = 0; v < vertices; ++v) {
    const double x = bumps.shape.positions(v, 0);
    options.parts.of_vertex.push_back(x < 10 ? 0 : x < 20 ? 1 : 2);
  }
  const Frames X = bumps.W * bumps.C;
  const Start start = start_of(X, around_one_bump(bumps), options);
  EXPECT_EQ(options.parts.of_vertex[start.centers[0]], 0);
  EXPECT_EQ(options.parts.of_vertex[start.centers[1]], 2);
  // All but a thousandth of the second part's motion is told by the first component.
  const Frames whole = bumps.C.row(1), told = start.components.frames().row(0);
  for (int v = 0; v < vertices; ++v) {
    if (options.parts.of_vertex[v] != 1) continue;
    EXPECT_NEAR((told - 0.999 * whole).middleCols(3 * v, 3).norm(), 0, 1e-12);
  }
}

TEST(GreedyStart, TakesPartsOfFullWeightAsThePaperDoes) {
  const Bumps bumps;
  DecompositionOptions options, weighted;
  options.count = weighted.count = 3;
  weighted.parts.weights = {1, 1};
  for (int v = 0; v < bumps.shape.positions.rows(); ++v) {
    weighted.parts.of_vertex.push_back(bumps.shape.positions(v, 0) < 10 ? 0 : 1);
  }
  const Frames X = bumps.W * bumps.C;
  const Start one = start_of(X, around_one_bump(bumps), options);
  const Start other = start_of(X, around_one_bump(bumps), weighted);
  EXPECT_EQ(one.centers, other.centers);
  EXPECT_TRUE(one.components.frames() == other.components.frames());
}

TEST(StrongestVertex, IsWhereWeightTimesEnergyIsLargestAndNoneWhereItIsZero) {
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3, 2), Eigen::Vector4d(0, 0.5, 0, 1)), 3);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3, 2), Eigen::Vector4d::Zero()), -1);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d::Zero()), -1);
}

TEST(StrongestVertex, IsTheLowestOfEquals) {
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3, 2)), 1);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3 * (1 + 1e-12), 2)), 1);
  EXPECT_EQ(strongest_vertex(Eigen::Vector4d(1, 3, 3 * (1 + 1e-8), 2)), 2);
}

}  // namespace
}  // namespace mimetra::test
