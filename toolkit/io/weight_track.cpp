#include "toolkit/io/weight_track.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "toolkit/io/csv.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/timecode.h"
#include "toolkit/io/weight_json.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Columns of captures that are not weights.
bool is_bookkeeping(std::string_view name) {
  const std::string plain = lower_case(std::string(name));
  return plain == "frame" || plain == "blendshapecount";
}

class WeightReader {
 public:
  explicit WeightReader(const std::filesystem::path& path) : path_(path), csv_(path) {}

  WeightTrack read() {
    choose_columns();
    while (csv_.next_row()) read_row();
    if (frames_ == 0) throw IoError(path_.string(), "has names but no row of weights");
    return track();
  }

 private:
  void choose_columns() {
    const auto& names = csv_.names();
    if (names.front().starts_with('{') || names.front().starts_with('[')) {
      throw IoError(path_.string(), "holds JSON, expected comma-separated values; call it .json");
    }
    if (names.size() == 1 && names.front().find(';') != std::string_view::npos) {
      csv_.fail("names are separated by ';', expected ','");
    }
    std::set<std::string_view> seen;
    for (std::size_t column = 0; column < names.size(); ++column) {
      const std::string_view name = names[column];
      if (name.empty()) csv_.fail("column " + std::to_string(column + 1) + " has no name");
      if (!seen.insert(name).second) csv_.fail("the name '" + std::string(name) + "' occurs twice");
      if (lower_case(std::string(name)) == "time") {
        if (time_column_) csv_.fail("the name 'time' occurs twice");
        time_column_ = column;
      } else if (lower_case(std::string(name)) == "timecode") {
        timecode_column_ = column;
      } else if (!is_bookkeeping(name)) {
        weight_columns_.push_back(column);
      }
    }
    if (weight_columns_.empty()) csv_.fail("no column of weights");
  }

  void read_row() {
    for (const std::size_t column : weight_columns_) weights_.push_back(csv_.number(column));
    if (time_column_) {
      const double time = csv_.number(*time_column_);
      if (!times_.empty() && time <= times_.back()) csv_.fail("times do not ascend");
      times_.push_back(time);
    } else if (timecode_column_) {
      read_timecode(csv_.field(*timecode_column_));
    }
    ++frames_;
  }

  void read_timecode(std::string_view text) {
    const auto code = Timecode::parse(text);
    if (!code) {
      csv_.fail("expected a timecode HH:MM:SS:FF, found '" + std::string(text) + "'");
    }
    if (!timecodes_.empty() && !passes(timecodes_.back(), *code)) {
      csv_.fail("the timecode " + std::string(text) + " is not later than the one before");
    }
    timecodes_.push_back(*code);
  }

  /// Of timecodes, which need each other.
  void find_times(WeightTrack& result) {
    if (timecodes_.size() < 2) return;
    const TimecodeTimes found = times_of(timecodes_);
    if (found.rate) {
      times_ = found.times;
    } else {
      result.notes.push_back(
          "no second ends among its timecodes, which would tell their rate; give it by option 'fps'");
    }
  }

  WeightTrack track() {
    WeightTrack result;
    find_times(result);
    const auto columns = static_cast<Eigen::Index>(weight_columns_.size());
    for (const std::size_t column : weight_columns_) {
      result.names.push_back(text_of_csv(csv_.names()[column]));
    }
    result.weights = Eigen::Map<const Frames>(weights_.data(), frames_, columns);
    result.times =
        Eigen::Map<const Eigen::VectorXd>(times_.data(), static_cast<Eigen::Index>(times_.size()));
    return result;
  }

  std::filesystem::path path_;
  CsvReader csv_;
  std::optional<std::size_t> time_column_, timecode_column_;
  std::vector<std::size_t> weight_columns_;
  std::vector<double> weights_;
  std::vector<double> times_;
  std::vector<Timecode> timecodes_;
  int frames_ = 0;
};

/// Blendshape weights are 0 to 1, and sometimes a little beyond.
constexpr double kMostUsual = 2;

/// What is to be said of weights that nobody means; "" where all are usual.
std::string note_on_size(const WeightTrack& track) {
  Eigen::Index frame = 0, column = 0;
  const double most = track.weights.cwiseAbs().maxCoeff(&frame, &column);
  if (most <= kMostUsual) return {};
  constexpr double kMany = 0.05;
  const auto beyond = static_cast<double>((track.weights.array() > 1.5).count());
  const bool many = beyond > kMany * static_cast<double>(track.weights.size());
  if (many && most <= 100 && track.weights.minCoeff() >= 0) {
    return "weights go up to " + readable(most) +
           " and look like percent, expected 0 to 1; they are taken as they are: divide them by "
           "100";
  }
  return "the weight of '" + track.names[static_cast<std::size_t>(column)] + "' is " +
         readable(track.weights(frame, column)) + " in frame " + std::to_string(frame) +
         ", expected 0 to 1";
}

void append(std::string& text, double number) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
}

void check_sizes(const WeightTrack& track) {
  const auto names = static_cast<Eigen::Index>(track.names.size());
  const Eigen::Index frames = track.weights.rows(), times = track.times.size();
  if (track.weights.cols() == names && (times == 0 || times == frames)) return;
  throw std::invalid_argument("a weight track has " + std::to_string(names) + " names, " +
                              std::to_string(times) + " times and " + std::to_string(frames) +
                              " x " + std::to_string(track.weights.cols()) +
                              " weights; expected times x names");
}

/// `mouthSmile_L` as captures write it: `mouthSmileLeft`.
std::string spelled_out(const std::string& name) {
  if (name.ends_with("_L")) return name.substr(0, name.size() - 2) + "Left";
  if (name.ends_with("_R")) return name.substr(0, name.size() - 2) + "Right";
  return name;
}

/// `browInnerUp` of `browInnerUp_L`.
std::string without_side(const std::string& name) {
  return name.ends_with("_L") || name.ends_with("_R") ? name.substr(0, name.size() - 2) : name;
}

std::string folded(const std::string& name) {
  std::string result = lower_case(std::string(name));
  std::erase(result, '_');
  return result;
}

int column_of(const std::vector<std::string>& names, const std::string& expression) {
  using Spelling = std::string (*)(const std::string&);
  const Spelling as_is = [](const std::string& name) { return name; };
  for (const Spelling spelling : {as_is, Spelling(spelled_out), Spelling(without_side)}) {
    const std::string wanted = spelling(expression);
    const auto exact = std::ranges::find(names, wanted);
    if (exact != names.end()) return static_cast<int>(exact - names.begin());
    const auto loose = std::ranges::find(names, folded(wanted), folded);
    if (loose != names.end()) return static_cast<int>(loose - names.begin());
  }
  return -1;
}

}  // namespace

WeightTrack read_weights(const std::filesystem::path& path) {
  const bool is_json = lower_extension(path) == ".json";
  WeightTrack track = is_json ? read_weights_json(path) : WeightReader(path).read();
  if (const std::string note = note_on_size(track); !note.empty()) track.notes.push_back(note);
  return track;
}

void write_weights(const std::filesystem::path& path, const WeightTrack& track, bool overwrite) {
  check_sizes(track);
  const bool timed = track.times.size() > 0;
  std::string text = timed ? "time" : "";
  for (const std::string& name : track.names) text += (text.empty() ? "" : ",") + csv_field(name);
  text += '\n';
  for (Eigen::Index f = 0; f < track.weights.rows(); ++f) {
    if (timed) append(text, track.times[f]);
    for (Eigen::Index j = 0; j < track.weights.cols(); ++j) {
      if (timed || j > 0) text += ',';
      append(text, track.weights(f, j));
    }
    text += '\n';
  }
  write_file(path, text, overwrite);
}

WeightMatch match_weights(const WeightTrack& track, const std::vector<std::string>& expressions) {
  WeightMatch match;
  std::vector<bool> used(track.names.size(), false);
  for (const std::string& expression : expressions) {
    const int column = column_of(track.names, expression);
    match.column.push_back(column);
    if (column >= 0)
      used[static_cast<std::size_t>(column)] = true;
    else
      match.undriven_expressions.push_back(expression);
  }
  for (std::size_t column = 0; column < used.size(); ++column) {
    if (!used[column]) match.unmatched_columns.push_back(track.names[column]);
  }
  return match;
}

Eigen::MatrixXd weights_for(const WeightTrack& track, const std::vector<std::string>& expressions) {
  const WeightMatch match = match_weights(track, expressions);
  if (match.undriven_expressions.size() == expressions.size()) {
    throw MismatchError(
        "no weight is named like an expression of the model: the weights begin with '" +
        (track.names.empty() ? "" : track.names.front()) + "', the expressions with '" +
        (expressions.empty() ? "" : expressions.front()) + "'");
  }
  Eigen::MatrixXd weights =
      Eigen::MatrixXd::Zero(track.weights.rows(), static_cast<Eigen::Index>(expressions.size()));
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    if (match.column[j] >= 0) {
      weights.col(static_cast<Eigen::Index>(j)) = track.weights.col(match.column[j]);
    }
  }
  return weights;
}

}  // namespace mimetra
