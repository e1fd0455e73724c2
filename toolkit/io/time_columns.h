#pragma once

#include <optional>
#include <string>

/// What columns and keys of times are called, and the numbers of frames. For the readers of weights
/// and landmarks.
namespace mimetra {

/// In how many units a column or key of this name counts a second, in any case and with or without
/// blanks: 1 for "time", "seconds", "time_s", "time (s)", "time_sec" and "time (sec)", and for "t",
/// 1000 for "timestamp_ms", "timestampMs", "time_ms", "time (ms)" and "ms". None for others: "T" is
/// a mouth's shape, and "timestamp" does not say its unit.
std::optional<double> units_per_second(std::string name);

/// The number of a frame that a file has as `value`; none for one with a fraction or of more than
/// 12 digits.
std::optional<long long> frame_number(double value);

}  // namespace mimetra
