#include "toolkit/io/time_columns.h"

#include <limits>

#include <gmock/gmock.h>

namespace mimetra {
namespace {

TEST(TimeColumns, CountInSecondsUnderSeveralNames) {
  for (const char* name :
       {"time", "Time", "Seconds", "time_s", "time(s)", "Time (s)", "time_sec", "time (sec)"}) {
    EXPECT_THAT(units_per_second(name), testing::Optional(1.0)) << name;
  }
}

TEST(TimeColumns, CountInMillisecondsWhereTheirNamesSaySo) {
  for (const char* name : {"timestamp_ms", "timestampMs", "Time_MS", "time(ms)", "time (ms)"})
    EXPECT_THAT(units_per_second(name), testing::Optional(1000.0)) << name;
}

TEST(TimeColumns, AreNoOthersAndNoneThatDoesNotSayItsUnit) {
  for (const char* name :
       {"", "timestamp", "Timestamp", "timecode", "times", "x_0", "frame", "t", "T", "ms"}) {
    EXPECT_EQ(units_per_second(name), std::nullopt) << name;
  }
}

TEST(FrameNumbers, AreWholeNumbersAlsoWithAPoint) {
  for (const long long number : {-7LL, 0LL, 1001LL, 999'999'999'999LL}) {
    EXPECT_THAT(frame_number(static_cast<double>(number)), testing::Optional(number));
  }
  for (const double other : {0.5, 1e12, -1e300, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(frame_number(other), std::nullopt) << other;
  }
}

}  // namespace
}  // namespace mimetra
