#include "toolkit/operations/reports.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(RegionReport, LeavesOutAnEnergyThatIsNotKnown) {
  const test::Shape grid = test::grid(4, 3);
  Regions regions = regions_from_vertices(12, grid.triangles, {{0}});
  EXPECT_TRUE(report_of(regions)["energy_share"].is_null());
  EXPECT_TRUE(report_of(regions)["regions"][0]["energy_share"].is_null());
  EXPECT_THAT(summary_of(regions), Not(HasSubstr("energy")));
  EXPECT_THAT(summary_of(regions), HasSubstr("1 region holds 1 vertex (8.3 %) and "));
  regions.energy_share = 0.5;
  EXPECT_EQ(report_of(regions)["energy_share"], 0.5);
  EXPECT_THAT(summary_of(regions), HasSubstr(" and 50.0 % of the motion energy"));
}

}  // namespace
}  // namespace mimetra
