#include <numbers>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/shapes.h"
#include "toolkit/pipeline/region_choice.h"
#include "toolkit/pipeline/source.h"

namespace mimetra {
namespace {

using test::Noted;
using test::take;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

Source still_source(const MeshSequence& sequence) {
  return prepare_source(sequence, {.head_motion = HeadMotion::none});
}

/// The first half of the vertices of take().
std::vector<bool> first_half() {
  std::vector<bool> inside(81, false);
  std::fill(inside.begin(), inside.begin() + 40, true);
  return inside;
}

AnalysisOptions in_first_half() {
  return {.count = 3, .inside = first_half()};
}

TEST(RegionPlace, HoldsAllCentresDisplacementsAndRegions) {
  const Analysis analysis = analyse(still_source(take()), in_first_half());
  const Components& components = analysis.components;
  EXPECT_THAT(components.centers, Each(testing::Lt(40)));
  EXPECT_TRUE(components.displacements.rightCols(3 * 41).isZero(0));
  EXPECT_FALSE(components.displacements.leftCols(3 * 40).isZero(0));
  for (const Region& region : choose_regions(analysis).regions) {
    EXPECT_THAT(region.vertices, Each(testing::Lt(40)));
  }
}

TEST(RegionPlace, IsNotTouchedByWhatMovesOutside) {
  const MeshSequence sequence = take();
  Frames frames = sequence.positions();
  frames.rightCols(3 * 41) += Frames::Random(frames.rows(), 3 * 41);
  const Components one = analyse(still_source(sequence), in_first_half()).components;
  const Components other =
      analyse(still_source(sequence.with_frames(frames)), in_first_half()).components;
  EXPECT_TRUE(one.displacements == other.displacements);
  EXPECT_TRUE(one.weights == other.weights);
}

TEST(RegionPlace, IsEverywhereWhereItHoldsAllVertices) {
  const MeshSequence sequence = take();
  AnalysisOptions options{.count = 3};
  const Components expected = analyse(still_source(sequence), options).components;
  options.inside.assign(81, true);
  EXPECT_TRUE(analyse(still_source(sequence), options).components.displacements ==
              expected.displacements);
}

TEST(RegionPlace, MovesTheCentresOfGivenComponents) {
  const MeshSequence sequence = take();
  const GivenComponents given{"take.h5", analyse(still_source(sequence), {.count = 5}).components};
  ASSERT_THAT(given.components.centers, testing::Contains(testing::Ge(40)));
  const Analysis analysis =
      analysis_of(given, sequence, moving_vertices(sequence), in_first_half());
  EXPECT_THAT(analysis.components.centers, Each(testing::Lt(40)));
}

TEST(RegionPlace, IsRefusedWithoutVertices) {
  AnalysisOptions options = in_first_half();
  options.inside.assign(81, false);
  EXPECT_EQ(test::topic_of([&] { analyse(still_source(take()), options); }),
            Topic::no_vertex_inside);
  options.inside.resize(80);
  EXPECT_THAT([&] { analyse(still_source(take()), options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("80 vertices, expected 81")));
}

/// A plate of 400 squares whose corner lifts, and a small, dense ball that rises as far.
MeshSequence plate_and_ball() {
  test::Shape ball = test::sphere(2);
  ball.positions *= 0.5;
  ball.positions.rowwise() += Eigen::RowVector3d(10, 10, 5);
  const test::Shape plate = test::grid(21, 21);
  const test::Shape shape = both(plate, ball);
  const auto vertices = static_cast<int>(shape.positions.rows());
  Frames frames(6, 3 * vertices);
  for (int f = 0; f < 6; ++f) {
    Positions pose = shape.positions;
    for (int v = 0; v < vertices; ++v) {
      const double lift = v < 441 ? std::max(0.0, 1 - pose.row(v).norm() / 8) : 1;
      pose(v, 2) += f * lift;
    }
    frames.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
  }
  return {Connectivity::from_triangles(vertices, shape.triangles), frames, {}, shape.positions};
}

TEST(SmallParts, AreNotedWhereRegionsLieOnThem) {
  Noted noted;
  const Source source = still_source(plate_and_ball());
  const AnalysisOptions options{.count = 2, .compatibility = Compatibility::splocs2013};
  const Regions regions = choose_regions(analyse(source, options), {}, noted.context());
  ASSERT_TRUE(noted.has(Topic::small_parts));
  EXPECT_THAT(
      regions.notes.back(),
      "1 of 2 regions lies on connected parts of less than 2 % of the surface: component 1");
  for (const Region& region : regions.regions) {
    EXPECT_EQ(region.surface_part, region.center < 441 ? 0 : 1);
  }
}

TEST(LargeRegions, AreNotedUnlessTheirRadiusIsALength) {
  Noted noted;
  const MeshSequence sequence = plate_and_ball();
  const Analysis analysis = analyse(still_source(sequence), {.count = 2});
  choose_regions(analysis, {.radius = Length::share(0.9)}, noted.context());
  EXPECT_TRUE(noted.has(Topic::large_regions));
  noted.notes.clear();
  choose_regions(analysis, {.radius = Length::of(0.9 * sequence.diameter())}, noted.context());
  choose_regions(analysis, {}, noted.context());
  choose_regions(analysis, {.radius = Length::share(0.9), .shape = RegionShape::support},
                 noted.context());
  EXPECT_FALSE(noted.has(Topic::large_regions));
}

TEST(PartWeights, AreSharesOfTheLargestPart) {
  const MeshSequence sequence = plate_and_ball();
  const PartWeights parts = part_weights(sequence.rest(), sequence.triangles());
  ASSERT_EQ(parts.weights.size(), 2U);
  EXPECT_EQ(parts.weights[0], 1);
  // A ball of radius 0.5, whose triangles lie within it, and a plate of 400.
  const double share = std::numbers::pi / 400;
  EXPECT_NEAR(parts.weights[1], share, 0.1 * share);
  std::vector<bool> only_ball(sequence.vertices(), false);
  std::fill(only_ball.begin() + 441, only_ball.end(), true);
  EXPECT_EQ(part_weights(sequence.rest(), sequence.triangles(), only_ball).weights[1], 1);
  EXPECT_TRUE(part_weights(take().rest(), take().triangles()).empty());
}

TEST(PartWeights, KeepCentresOffASmallPart) {
  const Source source = still_source(plate_and_ball());
  const Components components = analyse(source, {.count = 1}).components;
  EXPECT_LT(components.centers[0], 441);
}

TEST(ComponentCount, IsBoundedByWhatFramesTell) {
  Noted noted;
  AnalysisOptions options{.count = 60, .d_min = Length::share(0.9), .d_max = Length::share(1)};
  const Source source = still_source(take());
  const Components components = analyse(source, options, noted.context()).components;
  // One disc of d_min holds the patch, and there are 8 frames.
  EXPECT_EQ(components.count(), 8);
  ASSERT_FALSE(noted.notes.empty());
  EXPECT_THAT(noted.notes.front().text, HasSubstr("K = 60: 8 frames tell at most 8"));
  options.compatibility = Compatibility::splocs2013;
  EXPECT_EQ(component_count(take(), take().diameter(), options), 60);
}

}  // namespace
}  // namespace mimetra
