#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {
namespace {

TEST(Errors, AMessageAboutAFileStartsWithItsPath) {
  EXPECT_STREQ(IoError("a/face.obj", "no faces").what(), "a/face.obj: no faces");
  EXPECT_STREQ(OutputError("out.npy", "exists already").what(), "out.npy: exists already");
}

TEST(Errors, AMismatchIsTheCallersError) {
  EXPECT_THROW(throw MismatchError("other mesh"), std::invalid_argument);
}

TEST(Errors, CancelledSaysSo) {
  EXPECT_STREQ(Cancelled().what(), "cancelled");
}

TEST(Progress, ReachesTheCaller) {
  double seen = 0;
  const auto keep_going = [&seen](double share) {
    seen = share;
    return true;
  };
  report_progress(keep_going, 0.25);
  EXPECT_EQ(seen, 0.25);
}

TEST(Progress, ThatAsksToStopThrowsCancelled) {
  EXPECT_THROW(report_progress([](double) { return false; }, 0.5), Cancelled);
}

TEST(Progress, ThatIsAbsentIsNotCalled) {
  EXPECT_NO_THROW(report_progress({}, 0.5));
}

}  // namespace
}  // namespace mimetra
