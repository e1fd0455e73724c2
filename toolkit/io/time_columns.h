#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Names of columns and keys for times, frame numbers, and timecodes. For the readers of weights
/// and landmarks.
namespace mimetra {

/// Units per second in a column or key of this name, in any case and with or without blanks. 1 for
/// "time", "seconds", "time_s", "time (s)", "time_sec" and "time (sec)"; 1000 for "timestamp_ms",
/// "timestampMs", "time_ms" and "time (ms)". None for other names: "t" may be a mouth shape, "ms" a
/// duration, and "timestamp" has no unit.
std::optional<double> units_per_second(std::string name);

/// Other columns of weight files that are not weights, in lower case: a time without unit,
/// HH:MM:SS:FF, and the number of weights.
inline constexpr std::string_view kTimestamp = "timestamp", kTimecode = "timecode",
                                  kBlendshapeCount = "blendshapecount";

/// Whether a column or key of this name holds times, frame numbers, or one of the three above.
bool is_no_weight(const std::string& name);

/// Frame number from a file's `value`; none for fractions and for more than 12 digits.
std::optional<long long> frame_number(double value);
/// Frame number in a table's field, whose decimal point may be a comma; none for other text.
std::optional<long long> frame_number_in(std::string_view field);

/// Message that `time`, in seconds, is not later than the row before.
std::string note_on_falling_time(double before, double time);

/// Message that a column or key of this name does not number the frames.
std::string note_on_frame_numbers(const std::string& name);

/// Usual frame rates of cameras, per second.
inline constexpr std::array kUsualRates = {24, 25, 30, 48, 50, 60, 90, 100, 120, 240};

inline constexpr int kSecondsOfDay = 24 * 60 * 60;

/// Timecode `HH:MM:SS:FF` or `HH:MM:SS:FF.sss`: a second of the day, and the number of frames since
/// that second.
struct Timecode {
  int seconds;
  double frames;

  /// Parses a timecode. None for other text, and for drop-frame timecodes (`;FF`).
  static std::optional<Timecode> parse(std::string_view text);
};

/// Seconds since the first of several timecodes, and their frames per second: 60 if the last frame
/// of a second is 59. If no second ends among them, the rate is unknown and both are empty.
struct TimecodeTimes {
  std::optional<double> rate;
  std::vector<double> times;
};

/// Times of timecodes, which may pass midnight once. \pre each is later than the one before, as
/// passes() reports
TimecodeTimes times_of(const std::vector<Timecode>& codes);

/// True if `next` is later than `code`, possibly after midnight.
bool passes(const Timecode& code, const Timecode& next);

}  // namespace mimetra
