#include <limits>

#include <gmock/gmock.h>

#include "tests/splocs/synthetic.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra::test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// The bumps themselves as components.
Components true_components(const Bumps& bumps) {
  Components components;
  components.rest = bumps.shape.positions;
  components.triangles = bumps.shape.triangles;
  components.displacements = bumps.C;
  components.weights = bumps.W;
  components.centers = {6 * 30 + 5, 5 * 30 + 15, 6 * 30 + 24};
  return components;
}

TEST(DecompositionError, IsRoundingForTheTrueComponents) {
  const Bumps bumps;
  // Coordinates are up to 29: their sums carry 4e-15.
  EXPECT_LT(decomposition_error(bumps.sequence(), true_components(bumps)).rms, 1e-14);
}

TEST(DecompositionError, OfNoWeightsIsTheMotion) {
  const Bumps bumps;
  Components components = true_components(bumps);
  components.weights.setZero();
  const DecompositionError error = decomposition_error(bumps.sequence(), components);
  const Eigen::MatrixXd X = bumps.W * bumps.C;
  EXPECT_NEAR(error.rms, X.norm() / std::sqrt(X.size()), 1e-14);
  EXPECT_NEAR(error.relative_rms, error.rms / std::hypot(29, 11), 1e-14);
  EXPECT_NEAR(error.kg, 100 * X.norm() / (X.rowwise() - X.colwise().mean()).norm(), 1e-10);
}

TEST(DecompositionError, SparsityCountsVerticesThatStay) {
  const Bumps bumps;
  const DecompositionError error = decomposition_error(bumps.sequence(), true_components(bumps));
  int still = 0;
  for (int k = 0; k < 3; ++k) {
    for (int v = 0; v < bumps.shape.positions.rows(); ++v) {
      still += bumps.C.row(k).segment(3 * v, 3).isZero(0);
    }
  }
  EXPECT_DOUBLE_EQ(error.sparsity, still / (3.0 * 360));
}

TEST(DecompositionError, RefusesComponentsOfAnotherSequence) {
  const Bumps bumps;
  EXPECT_THAT([&] { decomposition_error(restless_grid(4, 3, 24), true_components(bumps)); },
              ThrowsMessage<MismatchError>(HasSubstr("360 vertices for a sequence of 12")));
  EXPECT_THAT([&] { decomposition_error(bumps.sequence().slice(0, 9), true_components(bumps)); },
              ThrowsMessage<MismatchError>(HasSubstr("24 frames for a sequence of 9")));
}

TEST(EnergyRadius, HoldsAllOfABumpWithinItsRadius) {
  const Bumps bumps;
  const Eigen::VectorXd radius = energy_radius(
      true_components(bumps), one_by_one(straight_distances(bumps.shape.positions)), 1);
  // The farthest grid point strictly inside a circle of radius 4 is (2, 3) or (3, 2) away.
  EXPECT_TRUE(radius.isApproxToConstant(std::hypot(2, 3)));
}

TEST(EnergyRadius, IsTheSmallestThatHoldsTheShare) {
  const Bumps bumps;
  const auto distances = straight_distances(bumps.shape.positions);
  const Components components = true_components(bumps);
  const double radius = energy_radius(components, one_by_one(distances), 0.95)[0];
  const Eigen::VectorXd from_center = distances(components.centers[0]);
  double within = 0, closer = 0;
  for (int v = 0; v < 360; ++v) {
    const double energy = bumps.C.row(0).segment(3 * v, 3).squaredNorm();
    if (from_center[v] <= radius) within += energy;
    if (from_center[v] < radius) closer += energy;
  }
  EXPECT_GE(within, 0.95 * bumps.C.row(0).squaredNorm());
  EXPECT_LT(closer, 0.95 * bumps.C.row(0).squaredNorm());
}

TEST(EnergyRadius, IsZeroWhereTheComponentDied) {
  const Bumps bumps;
  Components components = true_components(bumps);
  components.centers[1] = -1;
  const Eigen::VectorXd radius =
      energy_radius(components, one_by_one(straight_distances(bumps.shape.positions)));
  EXPECT_EQ(radius[1], 0);
  EXPECT_GT(radius[0], 0);
}

TEST(EnergyRadius, IsInfiniteWhereTheShareIsOutOfReach) {
  const Bumps bumps;
  const DistanceFunction nowhere = one_by_one([](VertexIndex source) {
    Eigen::VectorXd distances =
        Eigen::VectorXd::Constant(360, std::numeric_limits<double>::infinity());
    distances[source] = 0;
    return distances;
  });
  EXPECT_EQ(energy_radius(true_components(bumps), nowhere)[0],
            std::numeric_limits<double>::infinity());
}

TEST(EnergyRadius, RefusesSharesOutsideZeroToOne) {
  const Bumps bumps;
  for (const double share : {0.0, 1.5}) {
    EXPECT_THAT(
        [&] {
          energy_radius(true_components(bumps),
                        one_by_one(straight_distances(bumps.shape.positions)), share);
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr("share is")));
  }
}

}  // namespace
}  // namespace mimetra::test
