#include "toolkit/regions/falloff.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A strip of 21 x 5 vertices with unit spacing, on which the first columns are held.
class Falloff : public testing::Test {
 protected:
  static constexpr int kColumns = 21, kRows = 5;

  static Eigen::VectorXd first_columns(int count, double weight = 1) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(kColumns * kRows);
    for (int v = 0; v < weights.size(); ++v) {
      if (v % kColumns < count) weights[v] = weight;
    }
    return weights;
  }
  Eigen::VectorXd faded(const Eigen::VectorXd& weights, double falloff) const {
    return fading_out(weights, strip_.triangles, weld_, falloff, exact());
  }
  NearestDistance exact() const {
    return [distances =
                SurfaceDistances(strip_.positions, strip_.triangles, weld_, GeodesicMethod::exact)](
               std::span<const VertexIndex> sources) { return distances.from_nearest(sources); };
  }

  const test::Shape strip_ = test::grid(kColumns, kRows);
  const Weld weld_ = Weld::none(kColumns * kRows);
};

/// (1 - t)^2 (1 + 2 t), written out.
double cubic(double t) {
  return t < 1 ? 1 - 3 * t * t + 2 * t * t * t : 0;
}

TEST_F(Falloff, IsACubicOfTheDistanceFromTheRim) {
  const Eigen::VectorXd weights = faded(first_columns(4), 8);
  for (int v = 0; v < weights.size(); ++v) {
    const int column = v % kColumns;
    const double expected = column < 4 ? 1 : cubic((column - 3) / 8.0);
    EXPECT_NEAR(weights[v], expected, 1e-12) << v;
  }
  // Exactly at the end, and half way.
  EXPECT_EQ(weights[3 + 8], 0);
  EXPECT_NEAR(weights[3 + 4], 0.5, 1e-12);
}

TEST_F(Falloff, TakesTheLargerOneOfItAndWhatWasThere) {
  Eigen::VectorXd weights = first_columns(2);
  weights[5] = 0.9;
  weights[2] = 0.1;
  weights[20] = 0.3;
  const Eigen::VectorXd faded = this->faded(weights, 6);
  EXPECT_EQ(faded[5], 0.9);
  EXPECT_NEAR(faded[2], cubic(1 / 6.0), 1e-12);
  EXPECT_EQ(faded[20], 0.3);
  EXPECT_EQ(faded[19], 0);
}

TEST_F(Falloff, AsksForDistancesFromTheRimOnly) {
  std::vector<VertexIndex> asked;
  const NearestDistance watched = [&](std::span<const VertexIndex> sources) {
    asked.assign(sources.begin(), sources.end());
    return Eigen::VectorXd(Eigen::VectorXd::Constant(kColumns * kRows, 7));
  };
  fading_out(first_columns(4), strip_.triangles, weld_, 2, watched);
  EXPECT_THAT(asked, ElementsAre(3, 24, 45, 66, 87));
}

TEST_F(Falloff, LeavesWeightsWithoutARimAsTheyAre) {
  const test::Shape two = test::both(test::grid(3, 3), test::grid(3, 3));
  Eigen::VectorXd whole_part = Eigen::VectorXd::Zero(18);
  whole_part.head(9).setOnes();
  const NearestDistance none = [](std::span<const VertexIndex>) -> Eigen::VectorXd {
    throw std::logic_error("there is no rim");
  };
  EXPECT_TRUE(fading_out(whole_part, two.triangles, Weld::none(18), 5, none) == whole_part);
  EXPECT_TRUE(fading_out(first_columns(3, 0.5), strip_.triangles, weld_, 5, none) ==
              first_columns(3, 0.5));
}

TEST_F(Falloff, EndsWhereNoWayLeads) {
  const test::Shape two = test::both(test::grid(5, 2), test::grid(5, 2));
  const Weld weld = Weld::none(20);
  const SurfaceDistances distances(two.positions, two.triangles, weld, GeodesicMethod::exact);
  const Eigen::VectorXd weights = fading_out(
      Eigen::VectorXd::Unit(20, 0), two.triangles, weld, 100,
      [&](std::span<const VertexIndex> sources) { return distances.from_nearest(sources); });
  EXPECT_GT(weights.head(10).minCoeff(), 0.9);
  EXPECT_EQ(weights.tail(10).maxCoeff(), 0);
}

TEST_F(Falloff, GivesAWeldedPlaceOneWeight) {
  // Two halves that meet in a seam: columns 0 .. 4 and 4 .. 8.
  test::Shape halves = test::both(test::grid(5, 2), test::grid(5, 2));
  halves.positions.bottomRows(10).col(0).array() += 4;
  const Weld weld = Weld::exact(halves.positions);
  ASSERT_EQ(weld.count, 2);
  const SurfaceDistances distances(halves.positions, halves.triangles, weld, GeodesicMethod::exact);
  const auto nearest = [&](std::span<const VertexIndex> sources) {
    return distances.from_nearest(sources);
  };
  Eigen::VectorXd held = Eigen::VectorXd::Zero(20);
  held[4] = held[9] = 1;  // the seam, on one side
  const Eigen::VectorXd weights = fading_out(held, halves.triangles, weld, 4, nearest);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 5; ++column) {
      EXPECT_NEAR(weights[5 * row + column], cubic((4 - column) / 4.0), 1e-12);
      EXPECT_NEAR(weights[10 + 5 * row + column], cubic(column / 4.0), 1e-12);
    }
  }
  EXPECT_EQ(weights[4], weights[10]);
}

TEST_F(Falloff, MustBeALength) {
  for (const double falloff : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THAT([&] { faded(first_columns(4), falloff); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("falloff is ")));
  }
}

TEST(PaintedRegion, HoldsWhatTakesSomeOfTheMotion) {
  const test::Shape grid = test::grid(4, 3);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(12);
  weights[0] = 0.25;
  weights[1] = 1;
  const Regions regions = painted_region(weights, grid.triangles);
  ASSERT_EQ(regions.regions.size(), 1U);
  EXPECT_THAT(regions.regions[0].vertices, ElementsAre(0, 1));
  EXPECT_EQ(regions.vertex_count(), 2);
  // Squares 0, 1 and, from vertex 1 on, the triangles of 1 - 2 - 6 and 1 - 6 - 5.
  EXPECT_EQ(regions.triangles, triangles_in(weights, grid.triangles));
  EXPECT_THAT(regions.triangles, ElementsAre(0, 1, 2, 3));
  EXPECT_TRUE(regions.weights == weights);
  const std::vector<Field> fields = fields_of(regions);
  EXPECT_EQ(fields.back().name, "weight");
  EXPECT_EQ(fields.back().location, Field::Location::vertices);
  EXPECT_FALSE(fields.back().integer);
  EXPECT_TRUE(fields.back().values == weights);
}

TEST(PaintedRegion, RefusesOtherWeights) {
  const test::Shape grid = test::grid(4, 3);
  const auto message = [&](double weight) {
    return
        [&grid, weight] { painted_region(weight * Eigen::VectorXd::Unit(12, 5), grid.triangles); };
  };
  EXPECT_THAT(message(1.5), ThrowsMessage<std::invalid_argument>(
                                HasSubstr("weights: that of vertex 5 is 1.5, expected 0 to 1")));
  EXPECT_THAT(message(0), ThrowsMessage<std::invalid_argument>(HasSubstr("are 0")));
}

TEST(WithWeights, AddsToHardRegionsWhatTheirBorderHolds) {
  const test::Shape grid = test::grid(4, 3);
  const Regions hard = regions_from_vertices(12, grid.triangles, {{0}});
  EXPECT_EQ(fields_of(hard).back().name, "in_L");
  Eigen::VectorXd weights = Eigen::VectorXd::Unit(12, 0);
  weights[1] = 0.5;
  const Regions soft = with_weights(hard, weights, grid.triangles);
  EXPECT_THAT(soft.regions[0].vertices, ElementsAre(0));
  EXPECT_EQ(soft.vertex_count(), 2);
  EXPECT_GT(soft.triangles.size(), hard.triangles.size());
  const Regions moved = with_weights(hard, Eigen::VectorXd::Unit(12, 11), grid.triangles);
  EXPECT_EQ(moved.vertex_count(), 1);
  EXPECT_FALSE(moved.inside[0]);
  EXPECT_THAT([&] { with_weights(hard, Eigen::VectorXd::Ones(3), grid.triangles); },
              ThrowsMessage<std::invalid_argument>(
                  "weights: expected one for each of 12 vertices, found 3"));
}

}  // namespace
}  // namespace mimetra
