#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "toolkit/regions/falloff.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A patch that is shaken everywhere, so that no weights of the whole of it follow.
class RegionalSolution : public testing::Test {
 protected:
  RegionalSolution() { options_.solve.per_region = true; }

  TransferResult result() const { return transfer(source_, {{"actor", actor_}}, options_); }
  static double largest_difference(const Frames& a, const Frames& b) {
    return (a - b).cwiseAbs().maxCoeff();
  }

  const MeshSequence source_ = test::shaken(test::patch(), 12, 0.2);
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  TransferOptions options_{.analysis = {.count = 3}, .regions = {.radius = Length::share(0.2)}};
};

TEST_F(RegionalSolution, IsItsPartsDoneByHand) {
  const TransferResult found = result();
  const TransferredTarget& target = found.targets.front();
  const auto placed = carried(std::make_shared<const MeshSequence>(source_), target.similarity);
  const std::vector<int> all = all_triangles(actor_.triangles());

  std::vector<std::vector<VertexIndex>> lists;
  for (const Region& region : found.regions->regions) lists.push_back(region.vertices);
  const SurfaceDistances distances(actor_.neutral(), actor_.triangles(),
                                   Weld::exact(actor_.neutral()));
  const RegionShares shares = partition_of_unity(
      actor_.triangles(), distances.weld(), lists, 0.1 * diameter(actor_.neutral()),
      [&](std::span<const VertexIndex> sources) { return distances.from_nearest(sources); });
  const Eigen::MatrixXd global = BlendshapeTransfer(placed->rest(), actor_, all).weights(*placed);
  const RegionalWeights weights =
      LocalWeights(placed->rest(), actor_, shares, all).weights(*placed, global);
  EXPECT_TRUE(target.solution.weights() == weights.beta);
  EXPECT_EQ(target.solution.violation, weights.violation);
  const RegionalAnimation expected(std::make_shared<const BlendshapeModel>(actor_), shares,
                                   weights.beta);
  EXPECT_TRUE(test::frames_of(target.solution.sequence) == expected.read(0, 12));
}

TEST_F(RegionalSolution, MissesLessThanTheWholeFaces) {
  const double of_regions = result().targets.front().error.de_all;
  TransferOptions full = options_;
  full.full = true;
  full.solve.per_region = false;
  const double of_all = transfer(source_, {{"actor", actor_}}, full).targets.front().error.de_all;
  EXPECT_LT(of_regions, of_all);
  // Whatever the regions, an endless ridge gives the whole face's.
  options_.solve.region_ridge = 1e12;
  EXPECT_NEAR(result().targets.front().error.de_all, of_all, 1e-9 * of_all);
}

TEST_F(RegionalSolution, NamesWeightsByTheNumbersOfTheRegions) {
  const TransferResult found = result();
  const std::size_t regions = found.regions->regions.size();
  const Solution& solution = found.targets.front().solution;
  const std::vector<std::string> names = solution.weight_names();
  ASSERT_EQ(names.size(), (regions + 1) * 5);
  EXPECT_EQ(static_cast<Eigen::Index>(names.size()), solution.weights().cols());
  EXPECT_EQ(names[0], "shape0@0");
  EXPECT_EQ(names[5 * (regions - 1) + 2], "shape2@" + std::to_string(regions - 1));
  EXPECT_EQ(names.back(), "shape4@background");
  // A region's own motion: its weights alone move no vertex beyond its falloff.
  const RegionShares& shares = solution.regional->shares();
  for (std::size_t k = 0; k < regions; ++k) {
    for (const VertexIndex v : found.regions->regions[k].vertices) {
      EXPECT_GT(shares.coeff(v, static_cast<Eigen::Index>(k)), 0);
    }
  }
}

TEST_F(RegionalSolution, HasTheSourcesRegionsForEveryTarget) {
  // Completion would give each target discs of its own.
  options_.regions.complete = 0.95;
  const BlendshapeModel other = test::model_on(test::patch(), 9);
  const TransferResult found = transfer(source_, {{"actor", actor_}, {"other", other}}, options_);
  for (const TransferredTarget& target : found.targets) {
    ASSERT_EQ(target.regions->regions.size(), found.regions->regions.size());
    EXPECT_EQ(target.solution.regional->shares().cols(),
              static_cast<Eigen::Index>(found.regions->regions.size()) + 1);
  }
}

TEST_F(RegionalSolution, FollowsATargetOfOtherFaces) {
  // The same triangles in another order, paired one to one.
  const Triangles& triangles = actor_.triangles();
  const Triangles reversed = triangles.colwise().reverse();
  Correspondence pairs = Correspondence::identity(static_cast<int>(triangles.rows()));
  std::ranges::reverse(pairs.parts);
  const BlendshapeModel renumbered(
      std::make_shared<Connectivity>(Connectivity::from_triangles(actor_.vertices(), reversed)),
      actor_.neutral(), actor_.expressions());
  const Frames expected = test::frames_of(result().targets.front().solution.sequence);
  const TransferResult found =
      transfer(source_, {{.name = "actor", .model = renumbered, .match = pairs}}, options_);
  // Sums over the triangles come in another order.
  EXPECT_LT(largest_difference(test::frames_of(found.targets.front().solution.sequence), expected),
            1e-9);
}

TEST_F(RegionalSolution, RefusesWhatItCannotFollow) {
  const auto message = [this](const std::string& text) {
    EXPECT_THAT([this] { result(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  options_.solve.smoothness = 0.1;
  message("smoothness: weights of each region are found frame by frame");
  options_.solve.smoothness = 0;
  options_.solve.symmetry = 1;
  message("actor: weights of each region follow no rules of expressions");
  options_.solve.symmetry = 0;
  options_.solve.space = Space::vertex;
  message("per_region: actor is solved for vertices");
  options_.solve.space = Space::automatic;
  options_.solve.falloff = Length::share(0);
  message("falloff is 0");
  options_.solve.falloff = Length::share(0.1);
  options_.full = true;
  message("per_region: a full transfer has no regions");
}

}  // namespace
}  // namespace mimetra
