#include "toolkit/transfer/region_completion.h"

#include <cmath>

#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/blendshape_transfer.h"

namespace mimetra {
namespace {

/// A patch with bumps in several places, of which regions see one corner.
class RegionCompletionTest : public testing::Test {
 protected:
  static constexpr int kExpressions = 6;

  DiscSearch search(double radius = 1.5) const {
    const Positions& rest = actor_.neutral();
    return {rest, actor_.triangles(),
            SurfaceDistances(rest, actor_.triangles(), Weld::none(actor_.vertices())), radius};
  }

  Regions corner() const {
    return regions_from_vertices(actor_.vertices(), actor_.triangles(), {{0, 1, 9}});
  }

  CompletedRegions completed(const BlendshapeModel& target,
                             const CompletionOptions& options) const {
    DiscSearch search = this->search();
    return mimetra::completed(corner(), target, search, options);
  }

  /// G_L,jj / G_jj of every expression.
  Eigen::VectorXd shares(const BlendshapeModel& target, const Regions& regions) const {
    const auto all = all_triangles(target.triangles());
    return gram_diagonal(target, regions.triangles, EdgeSum::all)
        .cwiseQuotient(gram_diagonal(target, all, EdgeSum::all));
  }

  static double condition(const BlendshapeModel& target, const Regions& regions) {
    return BlendshapeTransfer(target.neutral(), target, regions.triangles).conditions().condition;
  }

  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), kExpressions);
};

TEST_F(RegionCompletionTest, SeesTheShareOfEveryExpression) {
  for (const double share : {0.05, 0.25, 0.6}) {
    const CompletedRegions result = completed(actor_, {.share = share, .limit = 1});
    EXPECT_LT(shares(actor_, corner()).minCoeff(), 0.05);
    EXPECT_GE(shares(actor_, result.regions).minCoeff(), share);
    EXPECT_FALSE(result.limited);
  }
}

TEST_F(RegionCompletionTest, KeepsTheRegionsAndMarksWhatItAddsForTheLeastSeenFirst) {
  const CompletedRegions result = completed(actor_, {.limit = 1});
  ASSERT_GT(result.added, 0);
  ASSERT_EQ(result.regions.regions.size(), 1u + result.added);
  EXPECT_EQ(result.regions.regions[0].vertices, (std::vector<VertexIndex>{0, 1, 9}));
  EXPECT_TRUE(result.regions.regions[0].added_for.empty());
  Eigen::Index least = 0;
  shares(actor_, corner()).minCoeff(&least);
  EXPECT_EQ(result.regions.regions[1].added_for, actor_.expressions().names[least]);
  for (int k = 1; k <= result.added; ++k) {
    const Region& disc = result.regions.regions[k];
    EXPECT_THAT(disc.added_for, testing::StartsWith("shape"));
    EXPECT_EQ(disc.radius, 1.5);
    EXPECT_THAT(disc.vertices, testing::Contains(disc.center));
  }
}

TEST_F(RegionCompletionTest, LeavesRegionsThatSeeEverything) {
  DiscSearch search = this->search();
  std::vector<VertexIndex> all(actor_.vertices());
  for (int v = 0; v < actor_.vertices(); ++v) all[v] = v;
  const Regions whole = regions_from_vertices(actor_.vertices(), actor_.triangles(), {all});
  const CompletedRegions result = mimetra::completed(whole, actor_, search);
  EXPECT_EQ(result.added, 0);
  EXPECT_EQ(result.regions.regions.size(), 1u);
  EXPECT_EQ(completed(actor_, {.share = 0}).added, 0);
}

TEST_F(RegionCompletionTest, StopsAtTheLimitAndSaysSo) {
  for (const double limit : {0.0, 0.1, 0.3}) {
    const CompletedRegions result = completed(actor_, {.share = 0.9, .limit = limit});
    EXPECT_TRUE(result.limited);
    EXPECT_LE(result.regions.triangle_share(), corner().triangle_share() + limit);
  }
}

TEST_F(RegionCompletionTest, PassesOverExpressionsThatMoveNothing) {
  ShapeBasis expressions = actor_.expressions();
  // What rounding in a file leaves of zeros.
  expressions.displacements.col(2) = 1e-7 * expressions.displacements.col(0);
  const BlendshapeModel target(actor_.shared_connectivity(), actor_.neutral(), expressions);
  const CompletedRegions result = completed(target, {.limit = 1});
  for (const Region& region : result.regions.regions) EXPECT_NE(region.added_for, "shape2");
  EXPECT_FALSE(result.limited);
}

TEST_F(RegionCompletionTest, TellsExpressionsApartThatDifferElsewhere) {
  // The second is the first, but for a trace of another bump; each is seen well by itself.
  ShapeBasis expressions = actor_.expressions();
  expressions.displacements.col(1) =
      expressions.displacements.col(0) + 0.05 * expressions.displacements.col(4);
  expressions.names.resize(2);
  expressions.displacements.conservativeResize(Eigen::NoChange, 2);
  const BlendshapeModel target(actor_.shared_connectivity(), actor_.neutral(), expressions);
  DiscSearch search = this->search();
  std::vector<VertexIndex> around;
  for (int v = 0; v < target.vertices(); ++v) {
    if (expressions.displacements.col(0).segment<3>(3 * v).norm() > 0.2) around.push_back(v);
  }
  const Regions first = regions_from_vertices(target.vertices(), target.triangles(), {around});
  ASSERT_GT(shares(target, first).minCoeff(), 0.25);
  ASSERT_GT(condition(target, first), kPoorCondition);
  const CompletedRegions result = mimetra::completed(first, target, search, {.limit = 1});
  EXPECT_GT(result.added, 0);
  EXPECT_LE(condition(target, result.regions), kPoorCondition);
}

TEST_F(RegionCompletionTest, DoesNotLookForADifferenceThatIsNowhere) {
  ShapeBasis expressions = actor_.expressions();
  expressions.displacements.col(1) = expressions.displacements.col(0);
  const BlendshapeModel target(actor_.shared_connectivity(), actor_.neutral(), expressions);
  const CompletedRegions result = completed(target, {.limit = 1});
  EXPECT_FALSE(result.limited);
  for (const Region& region : result.regions.regions) {
    EXPECT_THAT(region.added_for, testing::Not(testing::HasSubstr("combination")));
  }
  EXPECT_GE(shares(target, result.regions).minCoeff(), 0.25);
}

TEST_F(RegionCompletionTest, RefusesSharesOutOfRange) {
  EXPECT_THROW(completed(actor_, {.share = -0.1}), std::invalid_argument);
  EXPECT_THROW(completed(actor_, {.share = 1}), std::invalid_argument);
  EXPECT_THROW(completed(actor_, {.limit = 1.5}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
