#include "toolkit/io/live_link.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "toolkit/io/text_cursor.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Rotation columns, after the 52 blendshapes.
constexpr std::array kRotations = {"HeadYaw",     "HeadPitch",     "HeadRoll",
                                   "LeftEyeYaw",  "LeftEyePitch",  "LeftEyeRoll",
                                   "RightEyeYaw", "RightEyePitch", "RightEyeRoll"};

constexpr long long kThousandths = 1000;
/// Highest rate in frames per second: Timecode::parse() accepts frames below 1000.
constexpr double kFastest = 999;

/// Column of each expression; -1 for none.
std::vector<int> columns_of(const std::vector<std::string>& expressions) {
  WeightTrack arkit;
  arkit.names = live_link_names();
  return match_weights(arkit, expressions).column;
}

/// Frames per second of the timecodes: a usual rate within 1 % of the median, otherwise the median,
/// rounded.
int counted_rate(const Eigen::VectorXd& times) {
  if (times.size() < 2) return 30;
  const double found = 1 / median_difference(times);
  for (const int rate : kUsualRates) {
    // 29.97 becomes 30.
    if (std::abs(rate - found) < 0.01 * rate) return rate;
  }
  return static_cast<int>(std::lround(std::clamp(found, 1.0, kFastest)));
}

std::string two_digits(long long number) {
  return (number < 10 ? "0" : "") + std::to_string(number);
}

/// Timecode of `count` thousandths of frames since midnight.
std::string timecode_text(long long count, int rate) {
  const long long second = count / (rate * kThousandths) % kSecondsOfDay;
  const long long frames = count % (rate * kThousandths);
  const std::string thousandths = std::to_string(frames % kThousandths);
  return two_digits(second / 3600) + ':' + two_digits(second / 60 % 60) + ':' +
         two_digits(second % 60) + ':' + two_digits(frames / kThousandths) + '.' +
         std::string(3 - thousandths.size(), '0') + thousandths;
}

/// Note on times that reading the timecodes would not restore; none if it restores all.
std::optional<std::string> lost_times(const std::vector<Timecode>& codes,
                                      const Eigen::VectorXd& times, int rate) {
  if (codes.size() < 2) return {};
  const TimecodeTimes found = times_of(codes);
  if (!found.rate) {
    return "no second ends among its timecodes, which would tell their rate of " +
           std::to_string(rate) + "; give it by option 'fps' where it is read";
  }
  double largest = 0;
  for (std::size_t f = 0; f < codes.size(); ++f) {
    const double was = times[static_cast<Eigen::Index>(f)] - times[0];
    largest = std::max(largest, std::abs(found.times[f] - was));
  }
  // Each of the two timecodes is rounded by up to half of a thousandth of a frame.
  if (largest <= 2.0 / (rate * static_cast<double>(kThousandths))) return {};
  return "times are up to " + readable(largest, 3) + " s from the weights' where it is read";
}

std::vector<std::string> timecodes_of(const Eigen::VectorXd& times, bool are_known,
                                      std::vector<std::string>& notes) {
  const int rate = counted_rate(times);
  const double start = times.size() > 0 && times[0] >= 0 ? 0 : times[0];
  std::vector<std::string> texts;
  std::vector<Timecode> codes;
  for (Eigen::Index f = 0; f < times.size(); ++f) {
    const auto count = std::llround((times[f] - start) * rate * static_cast<double>(kThousandths));
    texts.push_back(timecode_text(count, rate));
    const auto code = Timecode::parse(texts.back());
    if (!code || (!codes.empty() && !passes(codes.back(), *code))) {
      throw MismatchError("frames " + std::to_string(f - 1) + " and " + std::to_string(f) +
                          " are at the same timecode " + texts.back() +
                          "; write .csv or .json, which keep times");
    }
    codes.push_back(*code);
  }
  if (!are_known) {
    notes.push_back("the weights have no times; their timecodes count " + std::to_string(rate) +
                    " frames a second");
  } else if (times.size() > 0 && times[0] != 0) {
    notes.push_back("the weights begin at " + readable(times[0]) +
                    " s; times are counted from the first frame where timecodes are read");
  }
  if (const auto lost = lost_times(codes, times, rate); lost && are_known) notes.push_back(*lost);
  return texts;
}

/// Weights in Live Link's columns (F x 52). Adds notes on dropped and shared expressions.
Eigen::MatrixXd in_columns(const WeightTrack& track, std::vector<std::string>& notes) {
  const std::vector<int> column = columns_of(track.names);
  const auto width = static_cast<Eigen::Index>(live_link_names().size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(track.weights.rows(), width);
  std::vector<int> held(live_link_names().size(), 0);
  std::vector<std::string> left_out, shared;
  for (std::size_t j = 0; j < column.size(); ++j) {
    if (column[j] < 0) {
      left_out.push_back(track.names[j]);
      continue;
    }
    ++held[static_cast<std::size_t>(column[j])];
    weights.col(column[j]) += track.weights.col(static_cast<Eigen::Index>(j));
  }
  if (left_out.size() == column.size()) {
    throw MismatchError("none of the expressions is one of ARKit's, which Live Link's columns are");
  }
  for (std::size_t c = 0; c < held.size(); ++c) {
    if (held[c] < 2) continue;
    weights.col(static_cast<Eigen::Index>(c)) /= held[c];
    shared.push_back(live_link_names()[c]);
  }
  if (!left_out.empty()) {
    notes.push_back("expressions that are not ARKit's are left out: " + listed(left_out));
  }
  if (!shared.empty()) {
    notes.push_back("columns that are the mean of several expressions: " + listed(shared));
  }
  return weights;
}

}  // namespace

const std::vector<std::string>& live_link_names() {
  static const std::vector<std::string> names = {"EyeBlinkLeft",
                                                 "EyeLookDownLeft",
                                                 "EyeLookInLeft",
                                                 "EyeLookOutLeft",
                                                 "EyeLookUpLeft",
                                                 "EyeSquintLeft",
                                                 "EyeWideLeft",
                                                 "EyeBlinkRight",
                                                 "EyeLookDownRight",
                                                 "EyeLookInRight",
                                                 "EyeLookOutRight",
                                                 "EyeLookUpRight",
                                                 "EyeSquintRight",
                                                 "EyeWideRight",
                                                 "JawForward",
                                                 "JawRight",
                                                 "JawLeft",
                                                 "JawOpen",
                                                 "MouthClose",
                                                 "MouthFunnel",
                                                 "MouthPucker",
                                                 "MouthRight",
                                                 "MouthLeft",
                                                 "MouthSmileLeft",
                                                 "MouthSmileRight",
                                                 "MouthFrownLeft",
                                                 "MouthFrownRight",
                                                 "MouthDimpleLeft",
                                                 "MouthDimpleRight",
                                                 "MouthStretchLeft",
                                                 "MouthStretchRight",
                                                 "MouthRollLower",
                                                 "MouthRollUpper",
                                                 "MouthShrugLower",
                                                 "MouthShrugUpper",
                                                 "MouthPressLeft",
                                                 "MouthPressRight",
                                                 "MouthLowerDownLeft",
                                                 "MouthLowerDownRight",
                                                 "MouthUpperUpLeft",
                                                 "MouthUpperUpRight",
                                                 "BrowDownLeft",
                                                 "BrowDownRight",
                                                 "BrowInnerUp",
                                                 "BrowOuterUpLeft",
                                                 "BrowOuterUpRight",
                                                 "CheekPuff",
                                                 "CheekSquintLeft",
                                                 "CheekSquintRight",
                                                 "NoseSneerLeft",
                                                 "NoseSneerRight",
                                                 "TongueOut"};
  return names;
}

bool has_live_link_names(const std::vector<std::string>& expressions) {
  return std::ranges::any_of(columns_of(expressions), [](int column) { return column >= 0; });
}

LiveLinkText live_link_csv(const WeightTrack& track) {
  LiveLinkText made;
  const Eigen::MatrixXd weights = in_columns(track, made.notes);
  const bool timed = track.times.size() > 0;
  const Eigen::VectorXd times =
      timed ? track.times : default_times(static_cast<int>(weights.rows()));
  const std::vector<std::string> codes = timecodes_of(times, timed, made.notes);
  const std::string count = std::to_string(live_link_names().size() + kRotations.size());
  made.text = "Timecode,BlendShapeCount";
  for (const std::string& name : live_link_names()) made.text += ',' + name;
  for (const char* name : kRotations) made.text += std::string(",") + name;
  made.text += '\n';
  for (Eigen::Index f = 0; f < weights.rows(); ++f) {
    made.text += codes[static_cast<std::size_t>(f)] + ',' + count;
    for (const double weight : weights.row(f)) {
      made.text += ',';
      append_number(made.text, weight);
    }
    for (std::size_t r = 0; r < kRotations.size(); ++r) made.text += ",0";
    made.text += '\n';
  }
  return made;
}

}  // namespace mimetra
