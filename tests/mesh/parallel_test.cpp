#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<std::atomic<int>> calls(100);
    parallel_for(
        100, [&calls](int i) { ++calls[static_cast<std::size_t>(i)]; },
        Context().with_threads(threads));
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelFor, OfNothingCallsNothing) {
  parallel_for(
      0, [](int) { FAIL(); }, Context().with_threads(2));
}

TEST(ParallelFor, ThrowsWhatTheLowestIndexThrew) {
  for (const int threads : {1, 4}) {
    try {
      parallel_for(
          8, [](int i) { throw std::runtime_error(std::to_string(i)); },
          Context().with_threads(threads));
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "0");
    }
  }
}

TEST(ParallelFor, ReportsProgressFromTheCallingThreadOnly) {
  const auto caller = std::this_thread::get_id();
  double last = 0;
  const auto rising = [&](double share) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_GT(share, last);
    last = share;
    return true;
  };
  parallel_for(
      50, [](int) {}, Context().with_threads(3).with_progress(rising));
  EXPECT_EQ(last, 1);
}

TEST(ParallelFor, StopsWhenTheCallerCancels) {
  std::atomic<int> calls = 0;
  const Context cancelled = Context().with_threads(1).with_progress([](double) { return false; });
  EXPECT_THROW(parallel_for(
                   1000000, [&calls](int) { ++calls; }, cancelled),
               Cancelled);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace mimetra
