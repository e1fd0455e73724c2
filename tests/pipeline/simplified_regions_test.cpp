#include "toolkit/pipeline/region_choice.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

Source source_of(const MeshSequence& sequence) {
  return prepare_source(sequence, {.head_motion = HeadMotion::none});
}

const AnalysisOptions kThree = {.count = 3};

TEST(SimplifiedRegions, OfAllVerticesAreTheRegions) {
  const MeshSequence sequence = take();
  const Regions expected = choose_regions(analyse(source_of(sequence), kThree));
  const SimplifiedRegions found = regions_by_simplified(source_of(sequence), {.share = 1}, kThree);
  ASSERT_EQ(found.regions.regions.size(), expected.regions.size());
  for (std::size_t i = 0; i < expected.regions.size(); ++i) {
    EXPECT_EQ(found.regions.regions[i].center, expected.regions[i].center);
    EXPECT_EQ(found.regions.regions[i].vertices, expected.regions[i].vertices);
  }
  EXPECT_EQ(found.regions.triangles, expected.triangles);
}

TEST(SimplifiedRegions, AreDiscsAlongTheWholeMesh) {
  const MeshSequence sequence = take();
  const SimplifiedRegions found = regions_by_simplified(source_of(sequence), {.share = 0.5}, kThree,
                                                        {.radius = Length::share(0.2)});
  EXPECT_LE(found.mesh.vertices.size(), std::size_t(0.6 * sequence.vertices()));
  const SurfaceDistances distances = distances_along(sequence.rest(), sequence.triangles());
  ASSERT_FALSE(found.regions.regions.empty());
  for (const Region& region : found.regions.regions) {
    EXPECT_TRUE(std::ranges::binary_search(found.mesh.vertices, region.center));
    EXPECT_EQ(region.radius, 0.2 * sequence.diameter());
    const Eigen::MatrixXd away = distances(std::span(&region.center, 1));
    std::vector<VertexIndex> expected;
    for (VertexIndex v = 0; v < sequence.vertices(); ++v) {
      if (away(v, 0) <= region.radius) expected.push_back(v);
    }
    EXPECT_EQ(region.vertices, expected);
  }
}

/// Share of all motion on the vertices that are inside.
double motion_inside(const MeshSequence& sequence, const std::vector<bool>& inside) {
  double all = 0, held = 0;
  for (VertexIndex v = 0; v < sequence.vertices(); ++v) {
    for (int f = 0; f < sequence.frames(); ++f) {
      const double squared = (sequence.frame(f) - sequence.rest()).row(v).squaredNorm();
      all += squared;
      if (inside[static_cast<std::size_t>(v)]) held += squared;
    }
  }
  return held / all;
}

TEST(SimplifiedRegions, HoldTheShareOfTheMotionOfAllVertices) {
  const MeshSequence sequence = take();
  const RegionChoiceOptions choice{.radius = Length::share(0.15)};
  const Regions all =
      regions_by_simplified(source_of(sequence), {.share = 0.4}, kThree, choice).regions;
  EXPECT_NEAR(all.energy_share, motion_inside(sequence, all.inside), 1e-12);
  // As many as it takes by that share.
  RegionChoiceOptions of_first = choice;
  of_first.coverage = 0.99 * all.regions.front().energy_share;
  const Regions first =
      regions_by_simplified(source_of(sequence), {.share = 0.4}, kThree, of_first).regions;
  EXPECT_EQ(first.regions.size(), 1U);
  EXPECT_GE(first.energy_share, *of_first.coverage);
  // More than there is is said.
  test::Noted noted;
  of_first.coverage = 1;
  regions_by_simplified(source_of(sequence), {.share = 0.4}, kThree, of_first, noted.context());
  EXPECT_TRUE(std::ranges::any_of(noted.notes, [](const Note& note) {
    return note.text.find("100 % were asked for") != std::string::npos;
  }));
}

TEST(SimplifiedRegions, LieWhereTheyMay) {
  const MeshSequence sequence = take();
  AnalysisOptions right = kThree;
  const double middle = sequence.rest().col(0).mean();
  for (VertexIndex v = 0; v < sequence.vertices(); ++v) {
    right.inside.push_back(sequence.rest()(v, 0) > middle);
  }
  const Regions found = regions_by_simplified(source_of(sequence), {.share = 0.5}, right).regions;
  for (VertexIndex v = 0; v < sequence.vertices(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    EXPECT_TRUE(right.inside[i] || !found.inside[i]);
  }
  // Of the motion there.
  EXPECT_NEAR(found.energy_share,
              motion_inside(sequence, found.inside) / motion_inside(sequence, right.inside), 1e-12);
}

TEST(SimplifiedRegions, RefuseRegionsThatAreNoDiscs) {
  const MeshSequence sequence = take();
  EXPECT_THAT(
      [&] {
        regions_by_simplified(source_of(sequence), {}, kThree, {.shape = RegionShape::support});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("discs")));
}

}  // namespace
}  // namespace mimetra
