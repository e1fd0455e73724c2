#include "toolkit/pipeline/simplified_regions.h"

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

const AnalysisOptions kThree = {.decomposition = {.count = 3}};

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
}

TEST(SimplifiedRegions, RefuseRegionsThatAreNoDiscs) {
  const MeshSequence sequence = take();
  EXPECT_THAT(
      [&] {
        regions_by_simplified(source_of(sequence), {}, kThree,
                              {.regions = {.shape = RegionShape::support}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("discs")));
}

}  // namespace
}  // namespace mimetra
