#include "toolkit/io/time_columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "toolkit/io/frame_series.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr std::array<std::string_view, 6> kNamesOfSeconds = {"time",    "seconds",  "time_s",
                                                             "time(s)", "time_sec", "time(sec)"};
constexpr std::array<std::string_view, 4> kNamesOfMilliseconds = {"timestamp_ms", "timestampms",
                                                                  "time_ms", "time(ms)"};

}  // namespace

std::optional<double> units_per_second(std::string name) {
  std::erase(name, ' ');
  const std::string plain = lower_case(std::move(name));
  if (std::ranges::find(kNamesOfSeconds, plain) != kNamesOfSeconds.end()) return 1;
  if (std::ranges::find(kNamesOfMilliseconds, plain) != kNamesOfMilliseconds.end()) return 1000;
  return {};
}

bool is_no_weight(const std::string& name) {
  const std::string plain = lower_case(name);
  return units_per_second(name) || holds_frame_numbers(name) || plain == kTimestamp ||
         plain == kTimecode || plain == kBlendshapeCount;
}

std::optional<long long> frame_number(double value) {
  constexpr double kMost = 1e12;
  if (!(std::abs(value) < kMost) || value != std::floor(value)) return {};
  return static_cast<long long>(value);
}

std::optional<long long> frame_number_in(std::string_view field) {
  std::string text(field);
  std::ranges::replace(text, ',', '.');
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last) return {};
  return frame_number(value);
}

std::string note_on_falling_time(double before, double time) {
  return "times do not ascend: " + readable(time, 9) + " is not later than the " +
         readable(before, 9) + " of the row before; leave out one of the rows, or the column";
}

std::string note_on_frame_numbers(const std::string& name) {
  return "'" + name +
         "' is not used, since it does not have a whole number in every frame, each higher than "
         "the one before; without times frames follow each other without a pause";
}

}  // namespace mimetra
