#include "toolkit/splocs/decomposition.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>

#include "geodesic/support_map.h"
#include "tests/splocs/literal_splocs.h"
#include "tests/splocs/synthetic.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/start.h"

namespace mimetra::test {
namespace {

// Products instead of residuals, and ten steps with an inverted instead of a solved system, change
// the last bits only: |X|^2 is some thousand times the smallest energy here, which leaves 1e-12.
constexpr double kRounding = 1e-9;

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

LiteralProblem literal_problem(const MeshSequence& sequence, const DecompositionOptions& options) {
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  Eigen::MatrixXd X = sequence.positions().rowwise() - rest;
  const double mean = options.scale == MotionScale::standard_deviation ? X.mean() : 0;
  X /= std::sqrt((X.array() - mean).square().mean());
  return {.X = X,
          .count = options.count,
          .sparsity = options.sparsity,
          .rho = options.rho,
          .iterations = *options.iterations,
          .admm_iterations = options.admm_iterations,
          .nonnegative = options.nonnegative,
          .literal_sign = options.sign_rule == SignRule::literal,
          .support = [&options](int center) {
            return geodesic::support_map(options.distances({&center, 1}), *options.d_min,
                                         *options.d_max);
          }};
}

/// Both decompositions after every number of iterations up to the options'.
void expect_literal(const MeshSequence& sequence, DecompositionOptions options) {
  const LiteralResult literal = literal_decomposition(literal_problem(sequence, options));
  const int iterations = *options.iterations;
  options.returned = ReturnedIterate::last;
  for (int done = 1; done <= iterations; ++done) {
    options.iterations = done;
    const Components components = decompose(sequence, options);
    const std::size_t last = done - 1;
    EXPECT_NEAR(components.energies.back() / literal.energy[last], 1, kRounding) << done;
    EXPECT_LT(relative_difference(components.weights, literal.W[last]), kRounding) << done;
    EXPECT_LT(relative_difference(components.displacements / components.scale, literal.C[last]),
              kRounding)
        << done;
    for (int k = 0; k < options.count; ++k) {
      const Eigen::VectorXd support = components.support.row(k);
      EXPECT_EQ(support[literal.centers[last][k]], 0) << k << " after " << done;
      EXPECT_EQ(components.centers[k], literal_strongest(literal.C[last].row(k)));
    }
  }
}

TEST(Decomposition, IsTheLiteralAlgorithmWithTheLiteralSignRule) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 6);
  options.sign_rule = SignRule::literal;
  options.scale = MotionScale::standard_deviation;
  expect_literal(sequence, options);
}

TEST(Decomposition, IsTheLiteralAlgorithmWithTheAmplitudeSignRule) {
  const MeshSequence sequence = restless_grid();
  expect_literal(sequence, grid_options(sequence, 6));
}

TEST(Decomposition, IsTheLiteralAlgorithmWithSignedWeights) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 4);
  options.nonnegative = false;
  expect_literal(sequence, options);
}

TEST(Decomposition, IsTheLiteralAlgorithmWithOtherPenaltiesAndStepCounts) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 5);
  options.sparsity = 0.7;
  options.rho = 3;
  options.iterations = 4;
  options.admm_iterations = 3;
  expect_literal(sequence, options);
}

TEST(Decomposition, IsTheLiteralAlgorithmAcrossBlocksOfVertices) {
  // 17 x 16 vertices: several blocks of 64 and a partial one.
  const MeshSequence sequence = restless_grid(17, 16, 12);
  DecompositionOptions options = grid_options(sequence, 4);
  options.iterations = 3;
  expect_literal(sequence, options);
}

/// Row of `components` that looks most like `bump`, by the cosine between them.
int most_like(const Components& components, const Eigen::RowVectorXd& field, double* cosine) {
  const Eigen::VectorXd cosines =
      (components.displacements * field.transpose()).array() /
      (components.displacements.rowwise().norm().array() * field.norm());
  int k = 0;
  *cosine = cosines.maxCoeff(&k);
  return k;
}

TEST(Decomposition, RecoversDisjointBumpsUpToOrderAndScale) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  DecompositionOptions options = grid_options(sequence, 3);
  // Nothing of a bump of radius 4 is penalised, and nothing of its neighbours is within 6.
  options.d_min = 4;
  const Components components = decompose(sequence, options);
  for (int b = 0; b < 3; ++b) {
    double cosine = 0;
    const int k = most_like(components, bumps.C.row(b), &cosine);
    // Exact in real numbers: what differs is rounding.
    EXPECT_NEAR(cosine, 1, 1e-12);
    const double peak = bumps.W.col(b).maxCoeff();
    EXPECT_LT((components.weights.col(k) - bumps.W.col(b) / peak).norm(), 1e-10);
    EXPECT_LT((components.displacements.row(k) - peak * bumps.C.row(b)).norm(), 1e-10);
  }
}

TEST(Decomposition, PutsCentersAtTheTopsOfDisjointBumps) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  const Components components = decompose(sequence, grid_options(sequence, 3));
  // Vertices of the grid, 30 a row, at (5, 6), (15, 5) and (24, 6).
  EXPECT_THAT(components.centers,
              testing::UnorderedElementsAre(6 * 30 + 5, 5 * 30 + 15, 6 * 30 + 24));
}

TEST(Decomposition, PutsCentersWherePartsCountMost) {
  // The right half moves twice as far as the left one, and counts a thousandth.
  const Shape shape = grid(20, 3);
  DecompositionOptions options;
  options.count = 1;
  options.sparsity = 0;
  options.distances = one_by_one(straight_distances(shape.positions));
  options.d_min = 1;
  options.d_max = 40;
  options.parts.weights = {1, 0.001};
  Frames poses =
      Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), shape.positions.size())
          .replicate(2, 1);
  for (int v = 0; v < shape.positions.rows(); ++v) {
    const double x = shape.positions(v, 0);
    options.parts.of_vertex.push_back(x < 10 ? 0 : 1);
    poses(1, 3 * v + 2) += (x < 10 ? 1 : 2) * std::exp(-(x - 9) * (x - 9) / 8);
  }
  const MeshSequence sequence(
      Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
      poses);
  const Components components = decompose(sequence, options);
  ASSERT_GE(components.centers[0], 0);
  EXPECT_EQ(shape.positions(components.centers[0], 0), 9);
}

TEST(Decomposition, ComponentsBeyondTheSequencesRankDie) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  DecompositionOptions options = grid_options(sequence, 5);
  options.d_min = 4;
  const Components components = decompose(sequence, options);
  EXPECT_EQ(std::ranges::count(components.centers, -1), 2);
  for (int k = 0; k < components.count(); ++k) {
    const bool dead = components.centers[k] < 0;
    EXPECT_EQ(components.displacements.row(k).isZero(0), dead);
    EXPECT_EQ(components.weights.col(k).isZero(0), dead);
  }
}

TEST(Decomposition, ASparsityThatOutweighsTheMotionKillsWhatLiesOutsideTheSupport) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 4);
  options.sparsity = 1e6;
  const Components components = decompose(sequence, options);
  for (int k = 0; k < components.count(); ++k) {
    for (int v = 0; v < components.vertices(); ++v) {
      if (components.support(k, v) == 0) continue;
      EXPECT_TRUE(components.displacements.row(k).segment(3 * v, 3).isZero(0)) << k << ' ' << v;
    }
  }
}

TEST(Decomposition, HasLessEnergyThanItsStart) {
  const MeshSequence sequence = restless_grid();
  const DecompositionOptions options = grid_options(sequence, 6);
  const LiteralProblem problem = literal_problem(sequence, options);
  const Start start =
      greedy_start(VertexBlocks<double>(problem.X), one_by_one(problem.support), options);
  const Frames C = start.components.frames();
  double energy = (problem.X - start.weights * C).squaredNorm();
  for (int k = 0; k < options.count; ++k) {
    const Eigen::RowVectorXd c = C.row(k);
    energy += options.sparsity *
              problem.support(literal_strongest(c)).dot(vertex_energies(c).cwiseSqrt());
  }
  EXPECT_LT(decompose(sequence, options).energies.back(), energy);
}

TEST(Decomposition, WeightsHaveMagnitudeOneAtMostAndSignsOnlyWhereTheyMay) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 6);
  for (const bool nonnegative : {true, false}) {
    options.nonnegative = nonnegative;
    const Components components = decompose(sequence, options);
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(components.weights.col(k).lpNorm<Eigen::Infinity>(), 1);
    }
    EXPECT_EQ(components.weights.minCoeff() >= 0, nonnegative);
  }
}

TEST(Decomposition, ScalingMeshAndLengthsScalesOnlyTheDisplacements) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 6);
  const Components components = decompose(sequence, options);
  const double factor = 37.5;
  const MeshSequence larger =
      sequence.with_frames(factor * sequence.positions()).with_rest(factor * sequence.rest());
  options = grid_options(larger, 6);
  options.d_min = factor * *options.d_min;
  options.d_max = factor * *options.d_max;
  const Components scaled = decompose(larger, options);
  EXPECT_EQ(scaled.centers, components.centers);
  EXPECT_NEAR(scaled.energies.back() / components.energies.back(), 1, kRounding);
  EXPECT_LT(relative_difference(scaled.weights, components.weights), kRounding);
  EXPECT_LT(relative_difference(scaled.displacements, factor * components.displacements),
            kRounding);
}

TEST(Decomposition, FollowsAnotherOrderOfVertices) {
  const MeshSequence sequence = restless_grid();
  const int vertices = sequence.vertices();
  std::vector<int> from(vertices);
  std::iota(from.begin(), from.end(), 0);
  std::ranges::shuffle(from, std::mt19937(3));
  Positions rest(vertices, 3);
  Frames frames(sequence.frames(), 3 * vertices);
  for (int v = 0; v < vertices; ++v) {
    rest.row(v) = sequence.rest().row(from[v]);
    frames.middleCols(3 * v, 3) = sequence.positions().middleCols(3 * from[v], 3);
  }
  const MeshSequence shuffled(Connectivity::from_triangles(vertices, Triangles(0, 3)), frames, {},
                              rest);
  const Components a = decompose(sequence, grid_options(sequence, 6));
  const Components b = decompose(shuffled, grid_options(shuffled, 6));
  EXPECT_LT(relative_difference(b.weights, a.weights), kRounding);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(from[b.centers[k]], a.centers[k]);
}

/// How many changes of the energy in a row, up to iteration `last` (from 0), are small.
int small_changes(const std::vector<double>& energies, int last, double tolerance) {
  int count = 0;
  for (int i = last; i > 0; --i, ++count) {
    if (std::abs(energies[i - 1] - energies[i]) > tolerance * energies[i - 1]) break;
  }
  return count;
}

TEST(Decomposition, EndsAtTheThirdSmallChangeOfTheEnergyInARow) {
  bool a_small_change_was_not_the_end = false;
  for (const unsigned seed : {7, 8, 9, 10, 11, 12}) {
    const MeshSequence sequence = restless_grid(14, 9, 20, seed);
    DecompositionOptions options = grid_options(sequence, 4);
    options.iterations = 1000;
    options.tolerance = 1e-3;
    const Components components = decompose(sequence, options);
    const auto last = static_cast<int>(components.energies.size()) - 1;
    ASSERT_LT(last, 999);
    EXPECT_EQ(components.converged, true);
    EXPECT_EQ(small_changes(components.energies, last, options.tolerance), 3);
    for (int i = 1; i < last; ++i) {
      const int count = small_changes(components.energies, i, options.tolerance);
      EXPECT_LT(count, 3) << i << " of seed " << seed;
      if (count > 0 && i + 3 <= last && small_changes(components.energies, i + 1, 1e-3) == 0) {
        a_small_change_was_not_the_end = true;
      }
    }
  }
  EXPECT_TRUE(a_small_change_was_not_the_end);
}

TEST(Decomposition, HasNotConvergedWhereIterationsRunOut) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 4);
  options.tolerance = 1e-12;
  const Components components = decompose(sequence, options);
  EXPECT_EQ(components.energies.size(), 10u);
  EXPECT_EQ(components.converged, false);
}

TEST(Decomposition, RunsAllIterationsWithoutATolerance) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  const Components components = decompose(sequence, grid_options(sequence, 3));
  EXPECT_EQ(components.energies.size(), 10u);
  // The bumps are found at once: it has converged by the usual tolerance.
  EXPECT_EQ(components.converged, true);
}

TEST(Decomposition, RunsTheUsualNumberOfIterationsUnlessAskedForAnother) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 4);
  options.iterations.reset();
  const Components components = decompose(sequence, options);
  EXPECT_EQ(components.energies.size(), std::size_t{DecompositionOptions::kUsualIterations});
  EXPECT_EQ(components.options.iterations, DecompositionOptions::kUsualIterations);
}

/// The energy of what a decomposition returned, from its definition.
double energy_of(const Components& components, const MeshSequence& sequence,
                 const DecompositionOptions& options) {
  const Frames C = components.displacements / components.scale;
  double energy = (literal_problem(sequence, options).X - components.weights * C).squaredNorm();
  for (int k = 0; k < components.count(); ++k) {
    const Eigen::VectorXd lengths = vertex_energies(C.row(k)).cwiseSqrt();
    energy += options.sparsity * components.support.row(k).dot(lengths);
  }
  return energy;
}

TEST(Decomposition, ReturnsTheIterateOfLeastEnergy) {
  int rising = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const MeshSequence sequence = restless_grid(9, 7, 10, seed);
    DecompositionOptions options = grid_options(sequence, 2 + static_cast<int>(seed) % 5);
    // Narrow support maps, which move far when a centre does.
    options.d_max = 3;
    options.iterations = 5 + static_cast<int>(seed);
    options.tolerance = seed % 2 == 0 ? 1e-4 : 0;
    const Components components = decompose(sequence, options);
    const double least = *std::ranges::min_element(components.energies);
    ASSERT_GE(components.iteration, 1);
    EXPECT_LE(components.energies.at(components.iteration - 1), least * (1 + options.tolerance));
    EXPECT_NEAR(energy_of(components, sequence, options) / least, 1, kRounding) << seed;
    rising += components.energies.back() > least;
  }
  EXPECT_GT(rising, 0) << "no energy rose: the test says nothing";
}

TEST(Decomposition, ReturnsTheLastIterateWhereItIsAskedFor) {
  int rising = 0;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const MeshSequence sequence = restless_grid(9, 7, 10, seed);
    DecompositionOptions options = grid_options(sequence, 2 + static_cast<int>(seed) % 5);
    options.d_max = 3;
    options.returned = ReturnedIterate::last;
    const Components components = decompose(sequence, options);
    EXPECT_EQ(components.iteration, 10);
    EXPECT_NEAR(energy_of(components, sequence, options) / components.energies.back(), 1,
                kRounding);
    rising += components.energies.back() > *std::ranges::min_element(components.energies);
  }
  EXPECT_GT(rising, 0) << "no energy rose: the last iterate is the best";
}

TEST(Decomposition, AsksForDistancesOnlyWhereACenterMoves) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  DecompositionOptions options = grid_options(sequence, 3);
  int asked = 0;
  options.distances =
      one_by_one([&, straight = straight_distances(sequence.rest())](VertexIndex source) {
        ++asked;
        return straight(source);
      });
  decompose(sequence, options);
  // Once in the start and once in the first iteration: the bumps' tops stay where they are.
  EXPECT_EQ(asked, 6);
}

/// Three bumps over 72 frames: motion of rank 3.
MeshSequence long_performance() {
  const Bumps bumps;
  return synthesised(bumps.shape, bumps.W.replicate(3, 1), bumps.C);
}

double largest_difference(const Components& a, const Components& b) {
  return (a.displacements - b.displacements).lpNorm<Eigen::Infinity>() /
         b.displacements.lpNorm<Eigen::Infinity>();
}

TEST(Decomposition, InABasisOfTimeIsTheSameForMotionOfLowRank) {
  const MeshSequence sequence = long_performance();
  DecompositionOptions options = grid_options(sequence, 3);
  const Components on_frames = decompose(sequence, options);
  options.basis_tolerance = 1e-6;
  // The basis loses nothing but rounding, which the tolerance of 1e-6 lets pass.
  EXPECT_LT(largest_difference(decompose(sequence, options), on_frames), 1e-5);
}

TEST(Decomposition, InSinglePrecisionIsTheSameToItsRounding) {
  const MeshSequence sequence = long_performance();
  DecompositionOptions options = grid_options(sequence, 3);
  const Components in_double = decompose(sequence, options);
  options.precision = IterationPrecision::single_precision;
  const Components in_single = decompose(sequence, options);
  // 6e-8 in each of 100 ADMM steps and some ten thousand sums.
  EXPECT_LT(largest_difference(in_single, in_double), 1e-4);
  EXPECT_NE(in_single.displacements, in_double.displacements);
  options.basis_tolerance = 1e-6;
  EXPECT_LT(largest_difference(decompose(sequence, options), in_double), 1e-4);
}

TEST(Decomposition, IsTheSameInEveryRun) {
  const MeshSequence sequence = restless_grid();
  const DecompositionOptions options = grid_options(sequence, 6);
  const Components a = decompose(sequence, options), b = decompose(sequence, options);
  EXPECT_EQ(a.displacements, b.displacements);
  EXPECT_EQ(a.weights, b.weights);
}

TEST(Decomposition, LengthsDefaultToSharesOfTheDiameter) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  DecompositionOptions options = grid_options(sequence, 3);
  options.d_min.reset();
  options.d_max.reset();
  const Components components = decompose(sequence, options);
  EXPECT_EQ(components.d_min, 0.1 * sequence.diameter());
  EXPECT_EQ(components.d_max, 0.7 * sequence.diameter());
}

TEST(Decomposition, ProgressPromisesNoMoreThanIsDoneAndIsAllDoneWhereItConvergesEarly) {
  const Bumps bumps;
  const MeshSequence sequence = bumps.sequence();
  DecompositionOptions options = grid_options(sequence, 3);
  options.iterations = 1000;
  options.tolerance = 1e-3;
  std::vector<double> shares;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  const std::size_t ran =
      decompose(sequence, options, Context().with_progress(keep)).energies.size();
  ASSERT_LT(ran, 20u);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  // The start is worth some iterations, and 980 of 1000 have not run.
  EXPECT_LT(shares.at(shares.size() - 2), 0.1);
  EXPECT_EQ(shares.back(), 1);
}

TEST(Decomposition, ProgressRisesToOneAndCancelsWhereverItIsReported) {
  const MeshSequence sequence = restless_grid();
  DecompositionOptions options = grid_options(sequence, 2);
  options.iterations = 2;
  std::vector<double> shares;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  decompose(sequence, options, Context().with_progress(keep));
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  for (std::size_t allowed = 0; allowed < shares.size(); ++allowed) {
    std::size_t reports = 0;
    const auto stop = [&reports, allowed](double) { return reports++ < allowed; };
    EXPECT_THROW(decompose(sequence, options, Context().with_progress(stop)), Cancelled) << allowed;
  }
}

}  // namespace
}  // namespace mimetra::test
