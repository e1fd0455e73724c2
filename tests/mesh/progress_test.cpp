#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {
namespace {

TEST(Progress, ReachesTheCallerWhoMayStop) {
  double seen = 0;
  const auto keep_going = [&seen](double share) {
    seen = share;
    return true;
  };
  report_progress(keep_going, 0.25);
  EXPECT_EQ(seen, 0.25);
  EXPECT_THROW(report_progress([](double) { return false; }, 0.5), Cancelled);
  EXPECT_NO_THROW(report_progress({}, 0.5));
}

TEST(Progress, OfAPartRunsFromItsBeginningToItsEnd) {
  std::vector<double> seen;
  const Progress whole = [&seen](double share) {
    seen.push_back(share);
    return share < 0.5;
  };
  const Progress part = part_of(whole, 0.25, 0.75);
  EXPECT_TRUE(part(0));
  EXPECT_FALSE(part(1));
  EXPECT_THAT(seen, testing::ElementsAre(0.25, 0.75));
  EXPECT_FALSE(part_of({}, 0, 1));
}

}  // namespace
}  // namespace mimetra
