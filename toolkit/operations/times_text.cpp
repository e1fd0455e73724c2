#include "toolkit/operations/times_text.h"

#include "toolkit/mesh/text.h"

namespace mimetra {

double seconds(const FrameSource& sequence) {
  return sequence.times()[sequence.frames() - 1] - sequence.times()[0];
}

std::string times_text(const FrameSource& sequence) {
  const Eigen::VectorXd& times = sequence.times();
  std::string text = readable(times[0]) + " to " + readable(times[times.size() - 1]) + " s";
  if (sequence.times_are_known()) return text;
  return text + " if there are " + readable(kDefaultFramesPerSecond) +
         " per second: the input says nothing of time";
}

void warn_of_guessed_rate(const Invocation& invocation, const std::string& name,
                          bool times_are_known) {
  if (times_are_known || invocation.parameters.number("smoothness") == 0) return;
  invocation.warn(name + ": says nothing of time, so that --smoothness takes its frames for " +
                  readable(kDefaultFramesPerSecond) + " a second; --fps tells how many there are");
}

}  // namespace mimetra
