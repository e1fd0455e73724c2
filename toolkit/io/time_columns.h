#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What columns and keys of times are called, the numbers of frames, and timecodes. For the readers
/// of weights and landmarks.
namespace mimetra {

/// In how many units a column or key of this name counts a second, in any case and with or without
/// blanks: 1 for "time", "seconds", "time_s", "time (s)", "time_sec" and "time (sec)", 1000 for
/// "timestamp_ms", "timestampMs", "time_ms" and "time (ms)". None for others: "t" may be a mouth's
/// shape, "ms" how long something took, and "timestamp" does not say its unit.
std::optional<double> units_per_second(std::string name);

/// Other columns of weights' files that are not weights, in lower case: a time without its unit,
/// HH:MM:SS:FF, and how many weights there are.
inline constexpr std::string_view kTimestamp = "timestamp", kTimecode = "timecode",
                                  kBlendshapeCount = "blendshapecount";

/// Whether a column or key of this name holds times, numbers of frames, or one of those.
bool is_no_weight(const std::string& name);

/// The number of a frame that a file has as `value`; none for one with a fraction or of more than
/// 12 digits.
std::optional<long long> frame_number(double value);
/// That in a field of a table, whose point may be a comma; none for other text.
std::optional<long long> frame_number_in(std::string_view field);

/// Says that `time`, in seconds, is not later than that of the row before.
std::string note_on_falling_time(double before, double time);

/// Says that what a column or key of this name holds does not number the frames.
std::string note_on_frame_numbers(const std::string& name);

/// What cameras count frames by, per second.
inline constexpr std::array kUsualRates = {24, 25, 30, 48, 50, 60, 90, 100, 120, 240};

inline constexpr int kSecondsOfDay = 24 * 60 * 60;

/// `HH:MM:SS:FF` or `HH:MM:SS:FF.sss`: a second of the day, and how many frames of it have passed.
struct Timecode {
  int seconds;
  double frames;

  /// None for what is no timecode, and for one that leaves out numbers of frames (`;FF`).
  static std::optional<Timecode> parse(std::string_view text);
};

/// Seconds since the first of several timecodes, and the frames per second that they count by: 60
/// where the last frame of a second is 59. Where no second ends among them nothing tells the rate,
/// and there are none.
struct TimecodeTimes {
  std::optional<double> rate;
  std::vector<double> times;
};

/// Timecodes may pass midnight once. \pre each is later than the one before: passes()
TimecodeTimes times_of(const std::vector<Timecode>& codes);

/// True where `next` is later than `code`, or is after midnight.
bool passes(const Timecode& code, const Timecode& next);

}  // namespace mimetra
