#include "toolkit/io/time_columns.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "toolkit/io/frame_series.h"
#include "toolkit/mesh/median.h"
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

namespace {

/// Seconds from one timecode to a later one, without frames.
int seconds_between(const Timecode& code, const Timecode& next) {
  const int seconds = next.seconds - code.seconds;
  return seconds < -kSecondsOfDay / 2 ? seconds + kSecondsOfDay : seconds;
}

/// Frames per second; none if the timecodes do not determine it.
std::optional<int> counted_frames(const std::vector<Timecode>& codes) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < codes.size(); ++i) {
    if (seconds_between(codes[i - 1], codes[i]) != 0) continue;
    steps.push_back(codes[i].frames - codes[i - 1].frames);
  }
  // At the change of a second, a usual step is the frames left in the old second and those in the
  // new one.
  std::vector<double> rates;
  double most = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    most = std::max(most, codes[i].frames);
    if (i == 0 || steps.empty()) continue;
    if (seconds_between(codes[i - 1], codes[i]) != 1) continue;
    rates.push_back(codes[i - 1].frames - codes[i].frames + median(steps));
  }
  if (rates.empty()) return {};
  const double found = median(rates);
  // Lost frames and irregular times leave at most a tenth of doubt.
  const int least = static_cast<int>(std::floor(most)) + 1;
  std::optional<int> nearest;
  for (const int rate : kUsualRates) {
    if (rate < least || std::abs(rate - found) > 0.1 * rate) continue;
    if (!nearest || std::abs(rate - found) < std::abs(*nearest - found)) nearest = rate;
  }
  return nearest ? nearest : std::max(least, static_cast<int>(std::lround(found)));
}

}  // namespace

std::optional<Timecode> Timecode::parse(std::string_view text) {
  constexpr std::array kMost = {24, 60, 60};
  std::array<int, 3> parts = {};
  Timecode code{};
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parts[part]);
    const auto used = static_cast<std::size_t>(end - text.data());
    const bool sound = error == std::errc() && parts[part] >= 0 && parts[part] < kMost[part];
    if (!sound || used >= text.size()) return {};
    if (text[used] != ':') return {};
    text.remove_prefix(used + 1);
  }
  code.seconds = (parts[0] * 60 + parts[1]) * 60 + parts[2];
  constexpr double kMostFrames = 1000;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), code.frames,
                                            std::chars_format::fixed);
  const bool sound = error == std::errc() && end == text.data() + text.size() && code.frames >= 0 &&
                     code.frames < kMostFrames;
  return sound ? std::optional(code) : std::nullopt;
}

TimecodeTimes times_of(const std::vector<Timecode>& codes) {
  TimecodeTimes result;
  const auto rate = counted_frames(codes);
  if (!rate) return result;
  result.rate = *rate;
  double days = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (i > 0 && codes[i].seconds < codes[i - 1].seconds) days += kSecondsOfDay;
    const double seconds = codes[i].seconds + days - codes.front().seconds;
    result.times.push_back(seconds + (codes[i].frames - codes.front().frames) / *rate);
  }
  return result;
}

bool passes(const Timecode& code, const Timecode& next) {
  const int seconds = seconds_between(code, next);
  return seconds > 0 || (seconds == 0 && next.frames > code.frames);
}

}  // namespace mimetra
