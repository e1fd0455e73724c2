#include "toolkit/regions/regions.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "tests/regions/moving_grid.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(Regions, AreTheDiscsOfTheirDefinition) {
  const Components components = lifted({at(2, 2), at(8, 1), at(5, 3)}, {1, 3, 2});
  const double radius = 2.1;
  const Regions regions = find_regions(components, disc_of(components, radius));
  ASSERT_EQ(regions.regions.size(), 3u);
  for (const Region& region : regions.regions) {
    std::vector<VertexIndex> expected;
    for (int v = 0; v < components.vertices(); ++v) {
      const auto from_center = components.rest.row(v) - components.rest.row(region.center);
      if (from_center.norm() <= radius) expected.push_back(v);
    }
    EXPECT_EQ(region.vertices, expected);
    EXPECT_EQ(region.radius, radius);
  }
}

TEST(Regions, StandInTheOrderOfTheirMotionEnergy) {
  const Components components = lifted({at(2, 2), at(8, 1), at(5, 3)}, {1, 3, 2});
  const Regions regions = find_regions(components, disc_of(components, 1));
  EXPECT_EQ(regions.regions[0].component, 1);
  EXPECT_EQ(regions.regions[1].component, 2);
  EXPECT_EQ(regions.regions[2].component, 0);
}

TEST(Regions, OfEqualEnergyStandInTheOrderOfTheirComponents) {
  const Components components = lifted({at(9, 2), at(2, 2)}, {1, 1});
  const Regions regions = find_regions(components, disc_of(components, 1));
  EXPECT_EQ(regions.regions[0].component, 0);
  EXPECT_EQ(regions.regions[1].component, 1);
}

TEST(MotionEnergy, IsThatOfTheComponentsOwnMotion) {
  Components components = lifted({at(2, 2), at(8, 1)}, {1, 3});
  components.weights = Eigen::MatrixXd::Random(4, 2);
  const Eigen::VectorXd energy = motion_energy(components);
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd motion = components.weights.col(k) * components.displacements.row(k);
    EXPECT_NEAR(energy[k] / motion.squaredNorm(), 1, 1e-14);
  }
}

TEST(Regions, LHoldsExactlyTheTrianglesThatTouchTheUnion) {
  const Components components = lifted({at(2, 2), at(8, 1)}, {1, 3});
  const Regions regions = find_regions(components, disc_of(components, 1));
  std::vector<int> expected;
  for (int t = 0; t < components.triangles.rows(); ++t) {
    bool touches = false;
    for (const Region& region : regions.regions) {
      for (const int corner : components.triangles.row(t)) {
        touches = touches || std::ranges::count(region.vertices, corner) > 0;
      }
    }
    if (touches) expected.push_back(t);
  }
  EXPECT_EQ(regions.triangles, expected);
  EXPECT_EQ(regions.all_triangles, components.triangles.rows());
}

TEST(Regions, UnionHoldsTheVerticesOfAllRegions) {
  const Components components = lifted({at(2, 2), at(3, 2)}, {1, 3});
  const Regions regions = find_regions(components, disc_of(components, 1));
  for (int v = 0; v < components.vertices(); ++v) {
    const bool held = std::ranges::any_of(regions.regions, [v](const Region& region) {
      return std::ranges::count(region.vertices, v) > 0;
    });
    EXPECT_EQ(regions.inside[v], held);
  }
  // Two crosses of five vertices that share their centres.
  EXPECT_EQ(regions.vertex_count(), 8);
  EXPECT_DOUBLE_EQ(regions.vertex_share(), 8.0 / 60);
}

TEST(Regions, HoldTheShareOfMotionEnergyOnTheirVertices) {
  const Components components = lifted({at(2, 2), at(8, 2)}, {2, 1});
  // Each lifts its centre by h and four neighbours by h / 2: h^2 on the centre of 2 h^2 in all.
  const Regions centers = find_regions(components, disc_of(components, 0.5));
  EXPECT_DOUBLE_EQ(centers.regions[0].energy_share, 4.0 / 10);
  EXPECT_DOUBLE_EQ(centers.regions[1].energy_share, 1.0 / 10);
  EXPECT_DOUBLE_EQ(centers.energy_share, 0.5);
  EXPECT_DOUBLE_EQ(find_regions(components, disc_of(components, 1)).energy_share, 1);
}

TEST(Regions, HoldTheEnergyOfWhatOverlappingComponentsGiveTogether) {
  Components components = lifted({at(2, 2), at(4, 2), at(8, 2)}, {2, -1, 1});
  components.weights = Eigen::MatrixXd::Random(7, 3);
  components.displacements += 0.3 * Frames::Random(3, components.displacements.cols());
  const Frames motion = components.weights * components.displacements;
  const Regions regions = find_regions(components, disc_of(components, 1.5));
  double inside = 0;
  for (int v = 0; v < components.vertices(); ++v) {
    const double energy = motion.middleCols(3 * v, 3).squaredNorm();
    EXPECT_NEAR(regions.vertex_energy[v], energy / motion.squaredNorm(), 1e-12);
    if (regions.inside[v]) inside += energy;
  }
  EXPECT_NEAR(regions.energy_share, inside / motion.squaredNorm(), 1e-12);
}

TEST(Regions, OfOneCenterAreMergedAndTheirEnergyAdded) {
  const Components components = lifted({at(2, 2), at(8, 2), at(2, 2)}, {2, 2.5, 2});
  const Regions regions = find_regions(components, disc_of(components, 1));
  ASSERT_EQ(regions.regions.size(), 2u);
  EXPECT_EQ(regions.regions[0].component, 0);
  EXPECT_DOUBLE_EQ(regions.regions[0].energy, 4 * (2 * 4 + 2 * 4));
  EXPECT_THAT(regions.notes,
              ElementsAre("components with the same centre share a region: 0 and 2"));
}

TEST(Regions, OfTwoCentersOnOneSeamAreMerged) {
  const Components components = lifted({at(2, 2), at(3, 2)}, {2, 1});
  RegionOptions options = disc_of(components, 1);
  // As a seam does: the two vertices are one point of the surface.
  options.distances =
      one_by_one([straight = straight_distances(components.rest)](VertexIndex source) {
        Eigen::VectorXd distances = straight(at(2, 2));
        if (source != at(2, 2) && source != at(3, 2)) distances = straight(source);
        distances[at(3, 2)] = distances[at(2, 2)];
        return distances;
      });
  const Regions regions = find_regions(components, options);
  ASSERT_EQ(regions.regions.size(), 1u);
  EXPECT_THAT(regions.regions[0].vertices, testing::Contains(at(3, 2)));
}

TEST(Regions, OfDeadComponentsDoNotExist) {
  const Components components = lifted({-1, at(8, 2), -1}, {0, 1, 0});
  const Regions regions = find_regions(components, disc_of(components, 1));
  ASSERT_EQ(regions.regions.size(), 1u);
  EXPECT_EQ(regions.regions[0].component, 1);
  EXPECT_THAT(regions.notes,
              ElementsAre("components 0 and 2 died in the decomposition: no region"));
}

TEST(Regions, OfOnlyDeadComponentsAreNone) {
  const Components components = lifted({-1}, {0});
  const Regions regions = find_regions(components, disc_of(components, 1));
  EXPECT_THAT(regions.regions, IsEmpty());
  EXPECT_THAT(regions.triangles, IsEmpty());
  EXPECT_EQ(regions.energy_share, 0);
}

TEST(Regions, NeverHoldVerticesOutOfReach) {
  const Components components = lifted({at(2, 2)}, {1});
  for (const RegionShape shape : {RegionShape::disc, RegionShape::support}) {
    RegionOptions options = disc_of(components, 1e300);
    options.shape = shape;
    options.distances =
        one_by_one([straight = straight_distances(components.rest)](VertexIndex source) {
          Eigen::VectorXd distances = straight(source);
          distances[at(3, 2)] = std::numeric_limits<double>::infinity();
          return distances;
        });
    const Regions regions = find_regions(components, options);
    EXPECT_FALSE(regions.inside[at(3, 2)]);
    EXPECT_TRUE(regions.inside[at(1, 2)]);
  }
}

TEST(Regions, HoldTheirCenterWhereItReachesNothing) {
  const Components components = lifted({at(2, 2)}, {1});
  RegionOptions options = disc_of(components, 1);
  options.distances = [](std::span<const VertexIndex> sources) {
    return Eigen::MatrixXd::Constant(kColumns * kRows, static_cast<Eigen::Index>(sources.size()),
                                     std::numeric_limits<double>::infinity());
  };
  EXPECT_THAT(find_regions(components, options).regions[0].vertices, ElementsAre(at(2, 2)));
}

TEST(Regions, RadiusDefaultsToATenthOfTheDiameter) {
  const Components components = lifted({at(2, 2)}, {1});
  RegionOptions options = disc_of(components, 1);
  options.radius.reset();
  EXPECT_DOUBLE_EQ(find_regions(components, options).regions[0].radius,
                   0.1 * diameter(components.rest));
}

TEST(SupportRegions, AreTheFewestVerticesWith95PercentOfTheEnergy) {
  // Random lengths all over the grid: every order of magnitude takes part.
  Components components = lifted({at(2, 2)}, {1});
  for (int i = 0; i < components.displacements.size(); ++i) {
    components.displacements(0, i) = std::exp(-0.01 * i) * std::sin(17.0 * i);
  }
  RegionOptions options = disc_of(components, 1);
  options.shape = RegionShape::support;
  const Region region = find_regions(components, options).regions[0];
  std::vector<double> energies;
  energies.reserve(static_cast<std::size_t>(components.vertices()));
  for (int v = 0; v < components.vertices(); ++v) {
    energies.push_back(components.displacements.row(0).segment(3 * v, 3).squaredNorm());
  }
  double held = 0, least = std::numeric_limits<double>::infinity();
  for (const VertexIndex v : region.vertices) {
    held += energies[v];
    least = std::min(least, energies[v]);
  }
  const double all = std::accumulate(energies.begin(), energies.end(), 0.0);
  EXPECT_GE(held, 0.95 * all);
  EXPECT_LT(held - least, 0.95 * all);
  EXPECT_NEAR(region.energy_share, held / all, 1e-14);
}

TEST(SupportRegions, ReachAsFarAsTheirFarthestVertex) {
  const Components components = lifted({at(2, 2)}, {1});
  RegionOptions options = disc_of(components, 1);
  options.shape = RegionShape::support;
  const Region region = find_regions(components, options).regions[0];
  EXPECT_THAT(region.vertices, ElementsAre(at(2, 1), at(1, 2), at(2, 2), at(3, 2), at(2, 3)));
  EXPECT_EQ(region.radius, 1);
}

TEST(Coverage, TakesTheFewestStrongestRegionsThatHoldIt) {
  const Components components = lifted({at(1, 2), at(5, 2), at(9, 2)}, {3, 2, 1});
  RegionOptions options = disc_of(components, 1);
  // The regions hold 9, 4 and 1 of 14 parts.
  const auto regions_for = [&](double coverage) {
    options.coverage = coverage;
    return find_regions(components, options).regions.size();
  };
  EXPECT_EQ(regions_for(0.1), 1u);
  EXPECT_EQ(regions_for(9.0 / 14), 1u);
  EXPECT_EQ(regions_for(0.65), 2u);
  EXPECT_EQ(regions_for(1), 3u);
}

TEST(Coverage, ShrinksTheUnionWithTheRegions) {
  const Components components = lifted({at(1, 2), at(9, 2)}, {3, 1});
  RegionOptions options = disc_of(components, 1);
  options.coverage = 0.5;
  const Regions regions = find_regions(components, options);
  EXPECT_FALSE(regions.inside[at(9, 2)]);
  EXPECT_DOUBLE_EQ(regions.energy_share, 0.9);
  EXPECT_THAT(regions.notes, IsEmpty());
}

TEST(Coverage, OutOfReachIsReported) {
  const Components components = lifted({at(1, 2), at(9, 2)}, {3, 1});
  RegionOptions options = disc_of(components, 0.5);
  options.coverage = 0.8;
  const Regions regions = find_regions(components, options);
  EXPECT_EQ(regions.regions.size(), 2u);
  EXPECT_THAT(regions.notes,
              ElementsAre("all 2 regions hold 50 % of the motion energy; 80 % were asked for"));
}

/// Components of a grid with three triangles beside it, of which component 0 lifts one corner each.
Components with_loose_triangles() {
  Components components = lifted({at(2, 2)}, {2});
  const Shape grid{components.rest, components.triangles};
  Shape whole = grid;
  for (int i = 0; i < 3; ++i) {
    const Shape triangle{
        (Positions(3, 3) << 20 + 2 * i, 0, 0, 21 + 2 * i, 0, 0, 20 + 2 * i, 1, 0).finished(),
        (Triangles(1, 3) << 0, 1, 2).finished()};
    whole = both(whole, triangle);
  }
  components.rest = whole.positions;
  components.triangles = whole.triangles;
  const Frames alone = components.displacements;
  components.displacements = Frames::Zero(1, whole.positions.size());
  components.displacements.leftCols(alone.cols()) = alone;
  for (int i = 0; i < 3; ++i) components.displacements(0, alone.cols() + 9 * i + 2) = 2;
  components.support = Eigen::MatrixXd::Zero(1, whole.positions.rows());
  return components;
}

TEST(Coverage, OutOfReachSaysHowMuchMovesOnPartsWithoutARegion) {
  // On the grid 2^2 + 4 = 8, on each triangle 2^2.
  const Components components = with_loose_triangles();
  RegionOptions options = disc_of(components, 1.5);
  options.coverage = 0.8;
  EXPECT_THAT(
      find_regions(components, options).notes,
      ElementsAre("the one region holds 40 % of the motion energy; 80 % were asked for; 60 % is "
                  "on parts of the mesh that have no region: small ones, such as teeth, move with "
                  "components of others"));
}

TEST(RegionOptions, RefuseARadiusAndACoverageOutOfRange) {
  const Components components = lifted({at(1, 2)}, {1});
  for (const double radius : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT([&] { find_regions(components, disc_of(components, radius)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("radius is")));
  }
  for (const double coverage : {0.0, 1.1}) {
    RegionOptions options = disc_of(components, 1);
    options.coverage = coverage;
    EXPECT_THAT([&] { find_regions(components, options); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("coverage is")));
  }
}

TEST(StrongestRegions, AreThoseOfTheStrongestComponentsAlone) {
  const Components all = lifted({at(1, 2), at(5, 2), at(9, 2)}, {3, 2, 1});
  const Regions two = strongest(find_regions(all, disc_of(all, 1)), 2, all.triangles);
  const Components first = lifted({at(1, 2), at(5, 2)}, {3, 2});
  const Regions expected = find_regions(first, disc_of(first, 1));
  EXPECT_EQ(two.inside, expected.inside);
  EXPECT_EQ(two.triangles, expected.triangles);
  // Of the motion of all three components.
  EXPECT_DOUBLE_EQ(two.energy_share, 13.0 / 14);
  EXPECT_EQ(strongest(two, 7, all.triangles).regions.size(), 2u);
}

TEST(StrongestRegions, RefuseACountOfZero) {
  EXPECT_THAT([] { strongest(Regions(), 0, Triangles(0, 3)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("count is 0")));
}

TEST(ReadRegions, HoldTheirVerticesOnceAndAscending) {
  const Shape shape = grid(3, 2);
  const Regions regions = regions_from_vertices(6, shape.triangles, {{4, 1, 4}, {0}});
  EXPECT_THAT(regions.regions[0].vertices, ElementsAre(1, 4));
  EXPECT_EQ(regions.regions[0].component, -1);
  EXPECT_EQ(regions.vertex_count(), 3);
}

TEST(ReadRegions, NameTheFirstVertexOutsideTheMesh) {
  const Shape shape = grid(3, 2);
  EXPECT_THAT(
      [&] {
        regions_from_vertices(6, shape.triangles, {{0}, {5, 6, -1}});
      },
      ThrowsMessage<MismatchError>(
          HasSubstr("region 1 holds vertex 6; the mesh has vertices 0 to 5")));
}

TEST(AllTriangles, AreAll) {
  EXPECT_THAT(all_triangles(grid(2, 3).triangles), ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace mimetra::test
