#include "toolkit/io/weight_file.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "toolkit/io/csv.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/missing_weights.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_options.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/io/timecode.h"
#include "toolkit/io/weight_json.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

class WeightReader {
 public:
  explicit WeightReader(const std::filesystem::path& path) : path_(path), csv_(path) {}

  WeightTrack read() {
    choose_columns();
    while (csv_.next_row(CsvReader::Rows::may_end_early)) read_row();
    if (frames_ == 0) throw IoError(path_.string(), "has names but no row of weights");
    return track();
  }

 private:
  void choose_columns() {
    const auto& names = csv_.names();
    if (names.front().starts_with('{') || names.front().starts_with('[')) {
      throw IoError(path_.string(), "holds JSON, expected comma-separated values; call it .json");
    }
    if (names.size() == 1 && names.front().find('\t') != std::string_view::npos) {
      csv_.fail("names are separated by tabs, expected ',' or ';'");
    }
    std::set<std::string_view> seen;
    for (std::size_t column = 0; column < names.size(); ++column) {
      const std::string_view name = names[column];
      if (name.empty()) csv_.fail("column " + std::to_string(column + 1) + " has no name");
      if (!seen.insert(name).second) csv_.fail("the name '" + std::string(name) + "' occurs twice");
      const std::string plain = lower_case(std::string(name));
      if (const auto units = units_per_second(std::string(name))) {
        take_times(column, *units);
      } else if (plain == kTimecode) {
        timecode_column_ = column;
      } else if (plain == kTimestamp) {
        notes_.push_back(note_on_timestamp(std::string(name)));
      } else if (holds_frame_numbers(plain)) {
        frame_column_ = column;
      } else if (plain != kBlendshapeCount) {
        weight_columns_.push_back(column);
      }
    }
    if (weight_columns_.empty()) csv_.fail("no column of weights");
  }

  /// Seconds go before milliseconds.
  void take_times(std::size_t column, double units) {
    if (time_column_ && units == units_per_second_) csv_.fail("there are two columns of times");
    if (time_column_ && units > units_per_second_) return;
    time_column_ = column;
    units_per_second_ = units;
  }

  void read_row() {
    const auto is_missing = [this](std::size_t column) {
      return csv_.field(column).empty() || lower_case(std::string(csv_.field(column))) == "nan";
    };
    const bool is_lost = std::ranges::all_of(weight_columns_, is_missing);
    for (const std::size_t column : weight_columns_) {
      const bool is_given = !is_missing(column) || (!is_lost && !csv_.is_given(column));
      weights_.push_back(is_given ? csv_.number(column) : kMissingWeight);
    }
    if (time_column_) {
      const double time = csv_.number(*time_column_) / units_per_second_;
      if (!times_.empty() && time <= times_.back()) {
        csv_.fail(note_on_falling_time(times_.back(), time));
      }
      times_.push_back(time);
    } else if (timecode_column_) {
      read_timecode(csv_.field(*timecode_column_));
    }
    if (frames_ == 0) {
      first_line_ = csv_.line();
      for (const std::size_t column : weight_columns_) {
        first_fields_.emplace_back(csv_.field(column));
      }
    }
    if (frame_column_) read_frame_number(csv_.field(*frame_column_));
    ++frames_;
  }

  /// A column of other things than whole numbers tells nothing.
  void read_frame_number(std::string_view text) {
    if (const auto frame = frame_number_in(text)) {
      frame_numbers_.push_back(*frame);
    } else {
      frame_note_ = note_on_frame_numbers(std::string(csv_.names()[*frame_column_]));
      frame_column_.reset();
      frame_numbers_.clear();
    }
  }

  void read_timecode(std::string_view text) {
    const auto code = Timecode::parse(text);
    if (!code) {
      csv_.fail("expected a timecode HH:MM:SS:FF, found '" + std::string(text) + "'");
    }
    if (!timecodes_.empty() && !passes(timecodes_.back(), *code)) {
      csv_.fail("the timecode " + std::string(text) +
                " is not later than the one before; leave out one of the rows, or the column");
    }
    timecodes_.push_back(*code);
  }

  /// Of timecodes, which need each other.
  void find_times(WeightTrack& result) {
    if (timecodes_.size() < 2) return;
    const TimecodeTimes found = times_of(timecodes_);
    if (found.rate) {
      times_ = found.times;
      if (found.skips_numbers) {
        result.notes.push_back(
            "its timecodes leave out the first numbers of minutes, as drop-frame timecodes do, and "
            "are read with a pause there; where no frame was lost, write ';' before their frames");
      }
    } else {
      result.notes.push_back(
          "no second ends among its timecodes, which would tell their rate; give it by option "
          "'fps'");
    }
  }

  WeightTrack track() {
    WeightTrack result;
    result.notes = std::move(notes_);
    find_times(result);
    if (times_.empty()) {
      RowNumbers numbers = row_numbers(frame_numbers_);
      result.step = static_cast<double>(numbers.step);
      if (!numbers.note.empty()) result.notes.push_back(std::move(numbers.note));
      if (!frame_note_.empty()) result.notes.push_back(frame_note_);
    }
    const auto columns = static_cast<Eigen::Index>(weight_columns_.size());
    for (const std::size_t column : weight_columns_) {
      result.names.push_back(text_of_csv(csv_.names()[column]));
    }
    result.weights = Eigen::Map<const Frames>(weights_.data(), frames_, columns);
    result.times =
        Eigen::Map<const Eigen::VectorXd>(times_.data(), static_cast<Eigen::Index>(times_.size()));
    check_columns(result);
    return result;
  }

  /// Each column holds a number.
  void check_columns(const WeightTrack& result) const {
    const bool is_empty = std::ranges::all_of(first_fields_, &std::string::empty);
    if (result.weights.array().isNaN().all() && is_empty) {
      throw IoError(path_.string(), "has no row with weights");
    }
    for (Eigen::Index column = 0; column < result.weights.cols(); ++column) {
      if (!result.weights.col(column).array().isNaN().all()) continue;
      const auto index = static_cast<std::size_t>(column);
      throw IoError(path_.string(), "line " + std::to_string(first_line_) + ": column '" +
                                        result.names[index] +
                                        "': expected a finite number, found '" +
                                        first_fields_[index] + "' and no other");
    }
  }

  std::filesystem::path path_;
  CsvReader csv_;
  int first_line_ = 0;                     ///< of weights
  std::vector<std::string> first_fields_;  ///< of the columns of weights
  std::optional<std::size_t> time_column_, timecode_column_, frame_column_;
  double units_per_second_ = 1;
  std::vector<long long> frame_numbers_;
  std::vector<std::size_t> weight_columns_;
  std::vector<double> weights_;
  std::vector<double> times_;
  std::vector<Timecode> timecodes_;
  std::vector<std::string> notes_;
  std::string frame_note_;  ///< on numbers of frames that are not used
  int frames_ = 0;
};

/// Blendshape weights are 0 to 1, and sometimes a little beyond.
constexpr double kMostUsual = 2, kLeastUsual = -0.1;

/// Weights that go beyond this and look like percent are nothing else.
constexpr double kLeastPercent = 10;

/// Whether many weights, in most columns that move, are beyond what weights from 0 to 1 are.
bool look_like_percent(const Eigen::MatrixXd& weights) {
  constexpr double kBeyond = 1.5, kMany = 0.05;
  const auto beyond = static_cast<double>((weights.array() > kBeyond).count());
  const Eigen::ArrayXd most = weights.colwise().maxCoeff().transpose();
  const double many = kMany * static_cast<double>(weights.size());
  const auto below = static_cast<double>((weights.array() < 10 * kLeastUsual).count());
  return beyond > many && below <= many && 2 * (most > kBeyond).count() > (most > 0).count() &&
         most.maxCoeff() <= 100 && weights.minCoeff() >= 100 * kLeastUsual;
}

/// Divides weights in percent by 100; notes that, and weights that nobody means. Only of `columns`.
void note_sizes(WeightTrack& track, const std::vector<int>& columns) {
  const Eigen::MatrixXd weights = track.weights(Eigen::all, columns);
  const auto note = [&](Eigen::Index frame, Eigen::Index column) {
    return "the weight of '" +
           track.names[static_cast<std::size_t>(columns[static_cast<std::size_t>(column)])] +
           "' is " + readable(weights(frame, column)) + " in frame " + std::to_string(frame) +
           ", expected 0 to 1";
  };
  Eigen::Index frame = 0, column = 0;
  const double most = weights.cwiseAbs().maxCoeff(&frame, &column);
  if (most <= kMostUsual) {
    if (weights.minCoeff(&frame, &column) >= kLeastUsual) return;
    track.notes.push_back(note(frame, column) + "; those below 0 are taken as they are");
    return;
  }
  if (look_like_percent(weights)) {
    const bool is_percent = most > kLeastPercent;
    if (is_percent) track.weights(Eigen::all, columns) = weights / 100;
    track.notes.push_back("weights go up to " + readable(most) +
                          " and look like percent, expected 0 to 1; " +
                          (is_percent ? "they are divided by 100"
                                      : "they are taken as they are: divide them by 100"));
    return;
  }
  track.notes.push_back(note(frame, column));
}

/// Once.
void note_odd_times(WeightTrack& track) {
  const std::string odd = note_on_steps(track.times);
  if (odd.empty() || std::ranges::find(track.notes, odd) != track.notes.end()) return;
  track.notes.push_back(odd);
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

}  // namespace

WeightTrack read_weights(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".npy" || extension == ".npz") {
    throw IoError(path.string(),
                  "is a NumPy array, which does not name its weights; expected .csv with a line of "
                  "names, or .json");
  }
  const bool is_json = extension == ".json";
  WeightTrack track = is_json ? read_weights_json(path) : WeightReader(path).read();
  fill_missing_weights(track);
  note_odd_times(track);
  return track;
}

void note_odd_weights(WeightTrack& track, const std::vector<std::string>& expressions) {
  std::vector<int> driving = match_weights(track, expressions).column;
  std::erase(driving, -1);
  std::ranges::sort(driving);
  driving.erase(std::unique(driving.begin(), driving.end()), driving.end());
  if (!driving.empty() && track.weights.rows() > 0) note_sizes(track, driving);
  note_odd_times(track);
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

}  // namespace mimetra
