#pragma once

#include <optional>
#include <string>
#include <string_view>

/// What columns and keys of times are called, and the numbers of frames. For the readers of weights
/// and landmarks.
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

}  // namespace mimetra
