#include "toolkit/io/weight_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "toolkit/io/csv.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_options.h"
#include "toolkit/io/timecode.h"
#include "toolkit/io/weight_json.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Names of a column of seconds, in lower case.
bool is_time(const std::string& name) {
  return name == "time" || name == "time (s)" || name == "time_s" || name == "seconds";
}

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
      if (is_time(plain)) {
        if (time_column_) csv_.fail("there are two columns of times");
        time_column_ = column;
      } else if (plain == "timecode") {
        timecode_column_ = column;
      } else if (plain == kTimestamp) {
        notes_.push_back(note_on_timestamp(std::string(name)));
      } else if (holds_frame_numbers(plain)) {
        frame_column_ = column;
      } else if (plain != "blendshapecount") {
        weight_columns_.push_back(column);
      }
    }
    if (weight_columns_.empty()) csv_.fail("no column of weights");
  }

  void read_row() {
    const auto is_missing = [this](std::size_t column) {
      return csv_.field(column).empty() || lower_case(std::string(csv_.field(column))) == "nan";
    };
    const bool is_lost = std::ranges::all_of(weight_columns_, is_missing);
    if (is_lost) lost_.push_back(frames_);
    for (const std::size_t column : weight_columns_) {
      const bool is_given = !is_missing(column) || (!is_lost && !csv_.is_given(column));
      weights_.push_back(is_given ? csv_.number(column) : kMissing);
    }
    if (time_column_) {
      const double time = csv_.number(*time_column_);
      if (!times_.empty() && time <= times_.back()) csv_.fail("times do not ascend");
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

  /// A column of other things than numbers tells nothing.
  void read_frame_number(std::string_view text) {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    constexpr long long kMost = 1'000'000'000'000;
    const bool is_number = error == std::errc() && end == text.data() + text.size();
    if (is_number && -kMost < number && number < kMost) {
      frame_numbers_.push_back(number);
    } else {
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
    }
    const auto columns = static_cast<Eigen::Index>(weight_columns_.size());
    for (const std::size_t column : weight_columns_) {
      result.names.push_back(text_of_csv(csv_.names()[column]));
    }
    result.weights = Eigen::Map<const Frames>(weights_.data(), frames_, columns);
    fill_missing(result);
    result.times =
        Eigen::Map<const Eigen::VectorXd>(times_.data(), static_cast<Eigen::Index>(times_.size()));
    return result;
  }

  /// Weights that are missing, as in rows where a capture lost the face, lie between their
  /// neighbours in the order of frames.
  void fill_missing(WeightTrack& result) const {
    const bool is_empty = std::ranges::all_of(first_fields_, &std::string::empty);
    if (static_cast<int>(lost_.size()) == frames_ && is_empty) {
      throw IoError(path_.string(), "has no row with weights");
    }
    std::vector<std::string> gaps;
    for (Eigen::Index column = 0; column < result.weights.cols(); ++column) {
      const std::string& name = result.names[static_cast<std::size_t>(column)];
      const auto missing = result.weights.col(column).array().isNaN().count();
      if (missing == frames_) {
        throw IoError(path_.string(), "line " + std::to_string(first_line_) + ": column '" + name +
                                          "': expected a finite number, found '" +
                                          first_fields_[static_cast<std::size_t>(column)] +
                                          "' and no other");
      }
      if (missing > std::ssize(lost_)) gaps.push_back(name);
      if (missing > 0) fill_gaps(result.weights.col(column));
    }
    if (!lost_.empty()) {
      result.notes.push_back(
          "rows without weights, which are taken from between their neighbours': " +
          listed(words_of(lost_)));
    }
    if (!gaps.empty()) {
      result.notes.push_back(
          "columns in which weights are missing, which are taken from between their neighbours': " +
          listed(gaps));
    }
  }

  /// \pre one number at least is not NaN
  static void fill_gaps(Eigen::Ref<Eigen::VectorXd> weights) {
    std::vector<Eigen::Index> seen;
    for (Eigen::Index f = 0; f < weights.size(); ++f) {
      if (!std::isnan(weights[f])) seen.push_back(f);
    }
    for (Eigen::Index f = 0; f < weights.size(); ++f) {
      if (!std::isnan(weights[f])) continue;
      const auto next = std::ranges::lower_bound(seen, f);
      const Eigen::Index after = next == seen.end() ? seen.back() : *next;
      const Eigen::Index before = next == seen.begin() ? after : *std::prev(next);
      const double share =
          after > before ? static_cast<double>(f - before) / static_cast<double>(after - before)
                         : 0;
      weights[f] = (1 - share) * weights[before] + share * weights[after];
    }
  }

  std::filesystem::path path_;
  CsvReader csv_;
  std::vector<int> lost_;                  ///< frames, ascending
  int first_line_ = 0;                     ///< of weights
  std::vector<std::string> first_fields_;  ///< of the columns of weights
  std::optional<std::size_t> time_column_, timecode_column_, frame_column_;
  std::vector<long long> frame_numbers_;
  std::vector<std::size_t> weight_columns_;
  std::vector<double> weights_;
  std::vector<double> times_;
  std::vector<Timecode> timecodes_;
  std::vector<std::string> notes_;
  int frames_ = 0;
};

/// Blendshape weights are 0 to 1, and sometimes a little beyond.
constexpr double kMostUsual = 2, kLeastUsual = -0.1;

/// Weights that go beyond this and look like percent are nothing else.
constexpr double kLeastPercent = 10;

bool look_like_percent(const Eigen::MatrixXd& weights) {
  constexpr double kMany = 0.05;
  const auto beyond = static_cast<double>((weights.array() > 1.5).count());
  return beyond > kMany * static_cast<double>(weights.size()) && weights.maxCoeff() <= 100 &&
         weights.minCoeff() >= 0;
}

std::string note_on_weight(const WeightTrack& track, Eigen::Index frame, Eigen::Index column) {
  return "the weight of '" + track.names[static_cast<std::size_t>(column)] + "' is " +
         readable(track.weights(frame, column)) + " in frame " + std::to_string(frame) +
         ", expected 0 to 1";
}

/// Divides weights in percent by 100; notes that, and weights that nobody means.
void note_sizes(WeightTrack& track) {
  Eigen::Index frame = 0, column = 0;
  const double most = track.weights.cwiseAbs().maxCoeff(&frame, &column);
  if (most <= kMostUsual) {
    if (track.weights.minCoeff(&frame, &column) >= kLeastUsual) return;
    track.notes.push_back(note_on_weight(track, frame, column) +
                          "; those below 0 are taken as they are");
    return;
  }
  if (look_like_percent(track.weights)) {
    const bool is_percent = most > kLeastPercent;
    if (is_percent) track.weights /= 100;
    track.notes.push_back("weights go up to " + readable(most) +
                          " and look like percent, expected 0 to 1; " +
                          (is_percent ? "they are divided by 100"
                                      : "they are taken as they are: divide them by 100"));
    return;
  }
  track.notes.push_back(note_on_weight(track, frame, column));
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
  note_odd_weights(track);
  return track;
}

void note_odd_weights(WeightTrack& track) {
  if (track.weights.size() > 0) note_sizes(track);
  if (const std::string odd = note_on_steps(track.times); !odd.empty()) track.notes.push_back(odd);
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
