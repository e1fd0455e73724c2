#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Timecodes of captures. Internal to the readers of weights.
namespace mimetra {

/// `HH:MM:SS:FF` or `HH:MM:SS:FF.sss`: a second of the day, and how many frames of it have passed.
/// A `;` before the frames says that numbers of frames are left out (29.97 and 59.94 per second).
struct Timecode {
  int seconds;
  double frames;
  bool drops_frames = false;

  /// None for what is no timecode.
  static std::optional<Timecode> parse(std::string_view text);
};

/// Seconds since the first of several timecodes, and the frames per second that they count by: 60
/// where the last frame of a second is 59. Where no second ends among them nothing tells the rate,
/// and there are none.
struct TimecodeTimes {
  std::optional<double> rate;
  std::vector<double> times;
  /// Numbers that drop-frame timecodes leave out are not there either, though all are counted.
  bool skips_numbers = false;
};

/// Timecodes may pass midnight once. \pre each is later than the one before: passes()
TimecodeTimes times_of(const std::vector<Timecode>& codes);

/// True where `next` is later than `code`, or is after midnight.
bool passes(const Timecode& code, const Timecode& next);

}  // namespace mimetra
