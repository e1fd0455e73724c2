#include "toolkit/mesh/context.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;

TEST(Progress, ReachesTheCallerWhoMayStop) {
  double seen = 0;
  const auto keep_going = [&seen](double share) {
    seen = share;
    return true;
  };
  Context().with_progress(keep_going).report(0.25);
  EXPECT_EQ(seen, 0.25);
  EXPECT_THROW(Context().with_progress([](double) { return false; }).report(0.5), Cancelled);
  EXPECT_NO_THROW(Context().report(0.5));
}

TEST(Progress, OfAPartRunsFromItsBeginningToItsEnd) {
  std::vector<double> seen;
  const auto keep = [&seen](double share) {
    seen.push_back(share);
    return share < 0.5;
  };
  const Context part = Context().with_progress(keep).part(0.25, 0.75);
  EXPECT_NO_THROW(part.report(0));
  EXPECT_THROW(part.report(1), Cancelled);
  EXPECT_THAT(seen, ElementsAre(0.25, 0.75));
  EXPECT_NO_THROW(Context().part(0, 1).report(1));
}

TEST(Progress, OfAPartOfAPartIsAShareOfThat) {
  std::vector<double> seen;
  const auto keep = [&seen](double share) {
    seen.push_back(share);
    return true;
  };
  const Context whole = Context().with_progress(keep);
  whole.part(0.5, 1).part(0.5, 1).report(0.5);
  whole.part(0.5, 1).part(0.5, 0.5).report(1);
  EXPECT_THAT(seen, ElementsAre(0.875, 0.75));
}

TEST(Context, PassesNotesOnUnlessItIsQuiet) {
  std::vector<std::string> noted;
  const Context context =
      Context().with_notes([&noted](const Note& note) { noted.push_back(note.text); });
  context.part(0, 0.5).note("first");
  context.quiet().note("second");
  context.serial().note("third");
  EXPECT_THAT(noted, ElementsAre("first"));
}

TEST(Context, OfWorkInAParallelLoopKeepsTheMemoryOnly) {
  const Context context = Context()
                              .with_threads(4)
                              .with_memory(1e9)
                              .with_progress([](double) { return false; })
                              .serial();
  EXPECT_EQ(context.threads(), 1);
  EXPECT_EQ(context.memory(), 1e9);
  EXPECT_NO_THROW(context.report(0.5));
}

}  // namespace
}  // namespace mimetra
