#include <algorithm>

#include <gmock/gmock.h>

#include "tests/regions/moving_grid.h"

namespace mimetra::test {
namespace {

const Field& named(const std::vector<Field>& fields, const std::string& name) {
  const auto field = std::ranges::find(fields, name, &Field::name);
  if (field == fields.end()) throw std::out_of_range(name);
  return *field;
}

/// Two discs that overlap; the stronger one is component 1.
struct Overlapping {
  Components components = lifted({at(2, 2), at(4, 2)}, {1, 2});
  Regions regions = find_regions(components, disc_of(components, 1));
};

TEST(RegionFields, HoldTheStrongestRegionItsCountTheUnionAndL) {
  const Overlapping discs;
  const std::vector<Field> fields = fields_of(discs.regions);
  for (const Field& field : fields) EXPECT_TRUE(field.integer);
  // -1 outside of all regions.
  const Field& region = named(fields, "region");
  EXPECT_EQ(region.values(at(4, 2)), 0);
  EXPECT_EQ(region.values(at(2, 2)), 1);
  EXPECT_EQ(region.values(at(3, 2)), 0);
  EXPECT_EQ(region.values(at(9, 2)), -1);
  const Field& count = named(fields, "region_count");
  EXPECT_EQ(count.values(at(3, 2)), 2);
  EXPECT_EQ(count.values(at(4, 2)), 1);
  EXPECT_EQ(count.values(at(9, 2)), 0);
  const Field& roi = named(fields, "roi");
  for (int v = 0; v < discs.regions.vertices; ++v) {
    EXPECT_EQ(roi.values(v), discs.regions.inside[v] ? 1 : 0);
  }
  const Field& in_L = named(fields, "in_L");
  EXPECT_EQ(in_L.location, Field::Location::triangles);
  EXPECT_EQ(in_L.values.sum(), discs.regions.triangles.size());
  for (const int t : discs.regions.triangles) EXPECT_EQ(in_L.values(t), 1);
}

TEST(AddedRegions, AreBehindTheOthersInTheUnionAndMarked) {
  const Overlapping discs;
  EXPECT_EQ(fields_of(discs.regions).size(), 4u);
  Region disc;
  disc.center = at(9, 2);
  disc.vertices = {at(4, 2), at(9, 2)};
  disc.added_for = "smile";
  const Regions more = with_added(discs.regions, {disc}, discs.components.triangles);
  ASSERT_EQ(more.regions.size(), 3u);
  EXPECT_EQ(more.regions.back().added_for, "smile");
  EXPECT_TRUE(more.inside[at(9, 2)]);
  EXPECT_EQ(more.vertex_count(), discs.regions.vertex_count() + 1);
  EXPECT_GT(more.triangles.size(), discs.regions.triangles.size());
  // What other regions hold is not added.
  const Field added = named(fields_of(more), "added");
  EXPECT_EQ(added.values(at(9, 2)), 1);
  EXPECT_EQ(added.values(at(4, 2)), 0);
  EXPECT_EQ(added.values.sum(), 1);
}

TEST(ComponentFields, BelongToTheRegionsInTheirOrder) {
  const Overlapping discs;
  const std::vector<Field> fields = component_fields(discs.components, discs.regions);
  // Region 0 is component 1, which lifts its centre by 2.
  const Field& displacement = named(fields, "component_0");
  EXPECT_EQ(displacement.values.row(at(4, 2)), Eigen::RowVector3d(0, 0, 2));
  EXPECT_EQ(displacement.values.cols(), 3);
  EXPECT_EQ(named(fields, "support_1").values.rows(), discs.regions.vertices);
}

TEST(ComponentFields, AreNoneForRegionsThatWereRead) {
  const Overlapping discs;
  const Regions read = regions_from_vertices(kColumns * kRows, discs.components.triangles, {{3}});
  EXPECT_TRUE(component_fields(discs.components, read).empty());
}

}  // namespace
}  // namespace mimetra::test
