#include "toolkit/io/frame_times.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

void check_rate(const std::string& name, const Eigen::VectorXd& times, std::optional<double> fps) {
  if (!fps || times.size() == 0) return;
  throw std::invalid_argument(name + ": its " + std::to_string(times.size()) +
                              " frames have times of their own, " + readable(times[0]) + " to " +
                              readable(times[times.size() - 1]) +
                              " s, and option 'fps' is for what has none; leave it out");
}

void check_times(const std::string& name, const Eigen::VectorXd& times) {
  for (Eigen::Index frame = 0; frame < times.size(); ++frame) {
    if (std::isfinite(times[frame]) && (frame == 0 || times[frame] > times[frame - 1])) continue;
    throw IoError(name, "frame " + std::to_string(frame) + " is at " + readable(times[frame]) +
                            " s, expected times that rise");
  }
}

std::string note_on_steps(const Eigen::VectorXd& times) {
  constexpr double kLongest = 1;
  constexpr Eigen::Index kMany = 10;
  if (times.size() < 2) return "";
  const double step = median_difference(times);
  const bool are_whole =
      times.size() >= kMany && step >= kLongest && (times.array() == times.array().round()).all();
  if (!(step > kLongest) && !are_whole) return "";
  return "its frames are " + readable(step) +
         " s apart (median), as where times are milliseconds or numbers of frames; expected "
         "seconds";
}

FrameTimes frame_times(const std::string& name, int frames, std::optional<Eigen::VectorXd> known,
                       std::optional<double> fps) {
  if (!known) {
    const double rate = fps.value_or(kDefaultFramesPerSecond);
    return {Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / rate, fps.has_value()};
  }
  check_rate(name, *known, fps);
  return {*std::move(known), true};
}

}  // namespace mimetra
