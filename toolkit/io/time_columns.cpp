#include "toolkit/io/time_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr std::array<std::string_view, 6> kNamesOfSeconds = {"time",    "seconds",  "time_s",
                                                             "time(s)", "time_sec", "time(sec)"};
constexpr std::array<std::string_view, 5> kNamesOfMilliseconds = {"timestamp_ms", "timestampms",
                                                                  "time_ms", "time(ms)", "ms"};

}  // namespace

std::optional<double> units_per_second(std::string name) {
  if (name == "t") return 1;
  std::erase(name, ' ');
  const std::string plain = lower_case(std::move(name));
  if (std::ranges::find(kNamesOfSeconds, plain) != kNamesOfSeconds.end()) return 1;
  if (std::ranges::find(kNamesOfMilliseconds, plain) != kNamesOfMilliseconds.end()) return 1000;
  return {};
}

std::optional<long long> frame_number(double value) {
  constexpr double kMost = 1e12;
  if (!(std::abs(value) < kMost) || value != std::floor(value)) return {};
  return static_cast<long long>(value);
}

}  // namespace mimetra
