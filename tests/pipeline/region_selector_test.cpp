#include "toolkit/pipeline/region_choice.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {
namespace {

using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RegionSelectorTest : public testing::Test {
 protected:
  TransferResult transferred(const RegionChoiceOptions& regions) {
    return transfer(source_, {{"actor", actor_}}, {.analysis = {.count = 4}, .regions = regions});
  }

  const MeshSequence source_ = take();
  // With fewer expressions than the source has, no transfer is exact.
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 3);
};

TEST_F(RegionSelectorTest, RegionsByEnergyAreTheStrongestThatFit) {
  const RegionChoiceOptions options{.radius = Length::share(0.12), .complete = 0};
  const Regions all = *transferred(options).regions;
  ASSERT_GT(all.regions.size(), 1U);
  for (std::size_t count = 1; count <= all.regions.size(); ++count) {
    const Regions first = strongest(all, static_cast<int>(count), source_.triangles());
    RegionChoiceOptions bounded = options;
    bounded.triangles = first.triangle_share();
    EXPECT_EQ(transferred(bounded).regions->triangles, first.triangles);
  }
}

TEST_F(RegionSelectorTest, CompletedRegionsStayWithinTheShare) {
  RegionChoiceOptions options{.radius = Length::share(0.12), .complete = 0.6, .complete_limit = 1};
  const double unbounded = transferred(options).regions->triangle_share();
  for (const double share : {0.3, 0.4, 0.5}) {
    ASSERT_GT(unbounded, share);
    options.triangles = share;
    const TransferResult result = transferred(options);
    EXPECT_LE(result.targets[0].regions->triangle_share(), share);
    EXPECT_EQ(result.regions->triangles, result.targets[0].regions->triangles);
  }
}

TEST_F(RegionSelectorTest, ReportsTheRegionsThatItSolvesBy) {
  const TransferResult result =
      transferred({.select = Selector::transfer, .triangles = 0.4, .radius = Length::share(0.3)});
  ASSERT_TRUE(result.regions);
  EXPECT_FALSE(result.components);
  EXPECT_LE(result.regions->triangle_share(), 0.4);
  const TransferResult by_them =
      transfer(source_, {{"actor", actor_}},
               {.given = GivenRegions{"chosen", *result.regions}, .regions = {.complete = 0}});
  EXPECT_TRUE(by_them.targets[0].solution.weights() == result.targets[0].solution.weights());
  EXPECT_EQ(by_them.targets[0].error.de_all, result.targets[0].error.de_all);
}

TEST_F(RegionSelectorTest, SaysWhatShareOfTheMotionRegionsHold) {
  const Regions regions =
      *transferred({.select = Selector::transfer, .triangles = 1.0, .radius = Length::share(0.3)})
           .regions;
  double inside = 0, all = 0;
  for (int f = 0; f < source_.frames(); ++f) {
    for (VertexIndex v = 0; v < source_.vertices(); ++v) {
      const double motion = (source_.frame(f).row(v) - source_.rest().row(v)).squaredNorm();
      all += motion;
      if (regions.inside[v]) inside += motion;
    }
  }
  EXPECT_NEAR(regions.energy_share, inside / all, 1e-12);
}

TEST_F(RegionSelectorTest, ChoosesForEachTarget) {
  const BlendshapeModel other = test::model_on(test::patch(), 5);
  const TransferOptions options{
      .regions = {.select = Selector::transfer, .triangles = 0.3, .radius = Length::share(0.3)}};
  const TransferResult both = transfer(source_, {{"actor", actor_}, {"other", other}}, options);
  EXPECT_FALSE(both.regions);
  const TransferResult second = transfer(source_, {{"other", other}}, options);
  EXPECT_EQ(both.targets[1].regions->triangles, second.regions->triangles);
}

TEST_F(RegionSelectorTest, IsBoundToWhereRegionsMayLie) {
  TransferOptions options{
      .regions = {.select = Selector::transfer, .triangles = 0.5, .radius = Length::share(0.3)}};
  options.analysis.inside.assign(source_.vertices(), false);
  for (VertexIndex v = 0; v < source_.vertices() / 2; ++v) options.analysis.inside[v] = true;
  const TransferResult result = transfer(source_, {{"actor", actor_}}, options);
  for (const Region& region : result.regions->regions) {
    for (const VertexIndex v : region.vertices) EXPECT_TRUE(options.analysis.inside[v]);
  }
}

TEST_F(RegionSelectorTest, RefusesATargetThatIsSolvedForVertices) {
  TransferOptions options{.regions = {.select = Selector::transfer}};
  options.solve.space = Space::vertex;
  EXPECT_EQ(test::topic_of([&] {
              transfer(source_, {{"actor", actor_}}, options);
            }),
            Topic::no_selection);
  EvaluationOptions curve{.curve = true};
  curve.solve.space = Space::vertex;
  EXPECT_EQ(test::topic_of([&] {
              evaluate(source_, {"actor", actor_}, curve);
            }),
            Topic::no_selection);
}

TEST_F(RegionSelectorTest, RefusesAShareThatHoldsNoRegion) {
  for (const Selector select : {Selector::energy, Selector::transfer}) {
    const RegionChoiceOptions options{
        .select = select, .triangles = 0.001, .radius = Length::share(0.3)};
    EXPECT_EQ(test::topic_of([&] { transferred(options); }), Topic::triangle_bound);
  }
}

TEST_F(RegionSelectorTest, CurveComparesBothAtEqualShares) {
  EvaluationOptions options{.curve = true, .regions = {.radius = Length::share(0.15)}};
  const auto rows = evaluate(source_, {"actor", actor_}, options);
  int by_energy = 0, by_transfer = 0;
  for (const EvaluationRow& row : rows) {
    if (!row.by) continue;
    EXPECT_LE(row.triangle_share, 0.8);
    // All triangles are best but for rounding.
    EXPECT_LE(*row.mpe_all, 1e-9);
    ++(*row.by == Selector::energy ? by_energy : by_transfer);
  }
  EXPECT_GT(by_energy, 0);
  EXPECT_GT(by_transfer, 2);
  EXPECT_FALSE(rows.back().by);
}

}  // namespace
}  // namespace mimetra
