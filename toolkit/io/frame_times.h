#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

/// Times of a sequence's frames, from files or from a frame rate.
namespace mimetra {

/// Seconds of a sequence's frames (F), and whether a file or the user gave them.
struct FrameTimes {
  Eigen::VectorXd seconds;
  bool are_known;
};

/// Throws std::invalid_argument if a frame rate is given although the frames of `name` have times
/// (F).
void check_rate(const std::string& name, const Eigen::VectorXd& times, std::optional<double> fps);

/// Throws IoError with `name` and the first frame whose time is not finite or not later than the
/// one before.
void check_times(const std::string& name, const Eigen::VectorXd& times);

/// Note on times (F) that are probably not in seconds: their median step exceeds a second, or ten
/// or more frames are at whole seconds, at least one apart. "" if there is nothing to note.
std::string note_on_steps(const Eigen::VectorXd& times);

/// Times of `name`: `known` if given, else from the frame rate or the default rate. Throws
/// std::invalid_argument if both are given.
FrameTimes frame_times(const std::string& name, int frames, std::optional<Eigen::VectorXd> known,
                       std::optional<double> fps);

}  // namespace mimetra
