#include "toolkit/io/weight_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/csv.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Note that a column of kTimestamp is not used.
std::string note_on_timestamp(const std::string& name) {
  return "'" + name +
         "' is not used, since it does not say its unit; call it 'time' where it is in seconds";
}

// Keys of mimetra's own files, Audio2Face's export for ARKit, and plain files.
const std::vector<std::string> kNames = {"names", "facsNames", "blendShapeNames", "blendshapes"};
const std::vector<std::string> kMatrix = {"weights", "weightMat"};
const std::string kTimesKey = "times";
const std::vector<std::string> kRate = {"fps", "exportFps"};
const std::vector<std::string> kRows = {"rows", "frames"};

// Keys of MediaPipe's Face Landmarker, from JavaScript and Python.
const std::vector<std::string> kCategories = {"faceBlendshapes", "face_blendshapes"};
const std::vector<std::string> kCategoryNames = {"categoryName", "category_name"};

Json parsed(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  check_encoding(path.string(), bytes);
  const std::string_view text = without_byte_order_mark(bytes);
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) throw IoError(path.string(), "is empty; expected weights");
  if (text[first] != '{' && text[first] != '[') {
    throw IoError(path.string(),
                  "is not JSON; where it holds comma-separated values, call it .csv");
  }
  return parse_json(path.string(), text, "weights as JSON");
}

class WeightJson {
 public:
  explicit WeightJson(const std::filesystem::path& path)
      : path_(path.string()), root_(parsed(path)) {}

  /// True for output of `mimetra fit`.
  bool is_fit() const { return member(root_, {"expressions"}) && member(root_, {"frames"}); }

  WeightTrack read() {
    const Json* names = member(root_, kNames);
    const Json* matrix = member(root_, kMatrix);
    if (names && matrix) {
      read_matrix(*names, *matrix);
    } else if (const Json* rows = root_.is_array() ? &root_ : member(root_, kRows)) {
      read_rows(*rows);
    } else if (const Json of_columns = rows_of_columns(); !of_columns.empty()) {
      read_rows(of_columns);
    } else {
      throw IoError(path_,
                    "holds no weights; expected names and weights, rows of them, or a list "
                    "for each name");
    }
    return std::move(track_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& message) const {
    throw IoError(path_, place + ": " + message);
  }

  /// Member of an object with the first matching key; null if there is none.
  static const Json* member(const Json& object, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) {
      const auto found = object.is_object() ? object.find(key) : object.end();
      if (object.is_object() && found != object.end()) return &*found;
    }
    return nullptr;
  }

  double number(const Json& value, const std::string& place) const {
    if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
    fail(place, "expected a finite number");
  }

  /// Weight in `value`; NaN for null, which is a missing weight.
  double weight(const Json& value, const std::string& place) const {
    return value.is_null() ? kMissingWeight : number(value, place);
  }

  /// Throws IoError if a column has no number.
  void check_columns(const std::string& place) const {
    for (Eigen::Index column = 0; column < track_.weights.cols(); ++column) {
      if (!track_.weights.col(column).array().isNaN().all()) continue;
      fail(place + ", '" + track_.names[static_cast<std::size_t>(column)] + "'",
           "expected a finite number there or in another row");
    }
  }

  void add_name(const std::string& name, const std::string& place) {
    if (name.empty()) fail(place, "expected a name, found ''");
    const auto index = static_cast<Eigen::Index>(track_.names.size());
    if (!columns_.emplace(name, index).second) fail(place, "the name '" + name + "' occurs twice");
    track_.names.push_back(name);
  }

  static bool holds_numbers(const Json& column) {
    return std::ranges::all_of(
        column, [](const Json& value) { return value.is_number() || value.is_null(); });
  }

  /// Rows from a list for each name, {"time": [0, 0.1], "jawOpen": [0, 1]}, or from an object of
  /// numbered rows for each name, {"jawOpen": {"0": 0, "1": 1}}. Empty if the file has another
  /// form.
  Json rows_of_columns() const {
    Json rows = Json::array();
    if (!root_.is_object()) return rows;
    std::string first;
    for (const auto& [name, column] : root_.items()) {
      // read_times() reads times of this name for all forms.
      if ((!column.is_array() && !column.is_object()) || name == kTimesKey) continue;
      if (!holds_numbers(column)) return Json::array();
      if (first.empty()) {
        first = name;
        rows.get_ref<Json::array_t&>().resize(column.size(), Json::object());
      } else if (column.size() != rows.size()) {
        fail("'" + name + "'", std::to_string(column.size()) + " numbers, expected " +
                                   std::to_string(rows.size()) + " as '" + first + "' has");
      }
      for (std::size_t row = 0; row < rows.size(); ++row) {
        const std::string index = std::to_string(row);
        if (column.is_object() && !column.contains(index)) {
          fail("'" + name + "'", "has no row " + index);
        }
        rows[row][name] = column.is_array() ? column[row] : column[index];
      }
    }
    return rows;
  }

  void read_matrix(const Json& names, const Json& matrix) {
    if (!names.is_array() || names.empty()) fail("names", "expected a list of names");
    for (const Json& name : names) {
      if (!name.is_string()) fail("names", "expected strings");
      add_name(name.get<std::string>(), "names");
    }
    if (!matrix.is_array() || matrix.empty()) fail("weights", "expected a list of rows");
    track_.weights.resize(static_cast<Eigen::Index>(matrix.size()),
                          static_cast<Eigen::Index>(names.size()));
    for (std::size_t f = 0; f < matrix.size(); ++f) {
      const std::string place = "weights/" + std::to_string(f);
      const Json& row = matrix[f];
      if (!row.is_array() || row.size() != names.size()) {
        fail(place, (row.is_array() ? std::to_string(row.size()) + " weights" : "no list") +
                        ", expected " + std::to_string(names.size()) + ", one for each name");
      }
      for (std::size_t j = 0; j < row.size(); ++j) {
        track_.weights(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(j)) =
            weight(row[j], place + "/" + std::to_string(j));
      }
    }
    check_columns("weights/0");
    read_times();
  }

  void read_times() {
    const Eigen::Index frames = track_.weights.rows();
    if (const Json* times = member(root_, {kTimesKey})) {
      if (!times->is_array() || static_cast<Eigen::Index>(times->size()) != frames) {
        fail("times", "expected " + std::to_string(frames) + " numbers, one for each row");
      }
      track_.times.resize(frames);
      for (Eigen::Index f = 0; f < frames; ++f) {
        set_time(f, number((*times)[static_cast<std::size_t>(f)], "times/" + std::to_string(f)),
                 "times/" + std::to_string(f));
      }
    } else if (const Json* rate = member(root_, kRate)) {
      const double fps = number(*rate, "fps");
      if (!(fps > 0)) fail("fps", "expected more than 0, found " + readable(fps));
      track_.times = times_at_rate(fps, frames, numbers_of_all());
    } else {
      RowNumbers numbers = row_numbers(numbers_of_all());
      track_.step = static_cast<double>(numbers.step);
      if (!numbers.note.empty()) track_.notes.push_back(std::move(numbers.note));
    }
  }

  void set_time(Eigen::Index frame, double time, const std::string& place) {
    if (frame > 0 && time <= track_.times[frame - 1]) {
      fail(place, note_on_falling_time(track_.times[frame - 1], time));
    }
    track_.times[frame] = time;
  }

  /// Reads rows of objects. Their keys are the weight names, in the row itself or in an object
  /// "weights". The first row defines the names.
  void read_rows(const Json& rows) {
    if (!rows.is_array() || rows.empty()) fail("rows", "expected a list of rows");
    const auto frames = static_cast<Eigen::Index>(rows.size());
    const bool timed = time_of(rows.front()).first != nullptr;
    if (timed) track_.times.resize(frames);
    for (const auto& [key, value] : rows.front().items()) {
      if (lower_case(key) == kTimestamp) track_.notes.push_back(note_on_timestamp(key));
    }
    for (Eigen::Index f = 0; f < frames; ++f) {
      const std::string place = "row " + std::to_string(f);
      const Json& row = rows[static_cast<std::size_t>(f)];
      if (!row.is_object()) fail(place, "expected an object of names and weights");
      const Json* nested = member(row, {"weights"});
      const Json* categories = member(row, kCategories);
      const Json scores = categories ? scores_of(*categories, place) : Json();
      const Json& weights = categories ? scores : nested && nested->is_object() ? *nested : row;
      const auto [time, units_per_second] = time_of(row);
      if ((time != nullptr) != timed)
        fail(place, timed ? "has no time" : "has a time, others none");
      if (time) set_time(f, number(*time, place + ", time") / units_per_second, place);
      if (const auto frame = frame_number_of(row)) frame_numbers_.push_back(*frame);
      const bool is_lost = categories && scores.empty();
      if (!is_lost) read_row(weights, f, frames, place);
    }
    if (track_.names.empty()) {
      fail("row 0", "expected the categories of one face there or in another row");
    }
    check_columns("row 0");
    if (!timed) read_times();
  }

  /// A row's time and its units per second, in which seconds precede milliseconds; null if the row
  /// has no time.
  static std::pair<const Json*, double> time_of(const Json& row) {
    if (!row.is_object()) return {nullptr, 1};
    std::pair<const Json*, double> found = {nullptr, 1};
    for (const auto& [key, value] : row.items()) {
      const auto units = units_per_second(key);
      if (units && (!found.first || *units < found.second)) found = {&value, *units};
    }
    return found;
  }

  /// Frame number from the first key that has one.
  std::optional<long long> frame_number_of(const Json& row) {
    for (const auto& [key, value] : row.items()) {
      if (!holds_frame_numbers(key)) continue;
      frame_key_ = key;
      if (!value.is_number()) continue;
      if (const auto number = frame_number(value.get<double>())) return number;
    }
    return {};
  }

  /// Frame numbers of all rows; empty, with a note, if some rows have none.
  std::vector<long long> numbers_of_all() {
    const bool all_have_one = std::ssize(frame_numbers_) == track_.weights.rows();
    if (frame_key_.empty() || all_have_one) return frame_numbers_;
    track_.notes.push_back(note_on_frame_numbers(frame_key_));
    return {};
  }

  /// MediaPipe's categories of one face, possibly in a list of faces, as an object of names and
  /// weights. "_neutral" is left out, since it is not an expression. Empty if there is no face.
  Json scores_of(const Json& found, const std::string& place) const {
    const Json* list = &found;
    if (list->is_null()) return Json::object();
    while (list->is_array() && list->size() == 1 && !member(list->front(), kCategoryNames)) {
      list = &list->front();
    }
    if (const Json* inner = member(*list, {"categories"})) list = inner;
    Json scores = Json::object();
    if (list->is_array() && list->empty()) return scores;
    if (!list->is_array()) fail(place, "expected the categories of one face");
    for (const Json& category : *list) {
      const Json* name = member(category, kCategoryNames);
      const Json* score = member(category, {"score"});
      if (!name || !name->is_string() || !score) {
        fail(place, "expected a category's \"categoryName\" and \"score\"");
      }
      if (*name != "_neutral") scores[name->get<std::string>()] = *score;
    }
    return scores;
  }

  void read_row(const Json& row, Eigen::Index frame, Eigen::Index frames,
                const std::string& place) {
    const auto is_weight = [](const std::string& key) { return !is_no_weight(key); };
    if (track_.names.empty()) {
      for (const auto& [key, value] : row.items()) {
        if (is_weight(key)) add_name(key, place);
      }
      if (track_.names.empty()) fail(place, "holds no weights");
      const auto columns = static_cast<Eigen::Index>(track_.names.size());
      track_.weights.setConstant(frames, columns, kMissingWeight);
    }
    Eigen::Index found = 0;
    for (const auto& [key, value] : row.items()) {
      if (!is_weight(key)) continue;
      const auto column = columns_.find(key);
      if (column == columns_.end()) fail(place, "'" + key + "' is no name of the first row");
      track_.weights(frame, column->second) = weight(value, place + ", '" + key + "'");
      ++found;
    }
    if (found != track_.weights.cols()) {
      fail(place, std::to_string(found) + " weights, expected " +
                      std::to_string(track_.weights.cols()) + " as in the first row");
    }
  }

  std::string path_;
  Json root_;
  WeightTrack track_;
  std::vector<long long> frame_numbers_;
  std::string frame_key_;
  std::map<std::string, Eigen::Index> columns_;
};

/// Reads a JSON file in any of the forms of read_weights().
WeightTrack read_weights_json(const std::filesystem::path& path) {
  WeightJson json(path);
  return json.is_fit() ? read_fit(path).performance() : json.read();
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
      if (const auto units = units_per_second(std::string(name))) {
        take_times(column, *units);
      } else if (plain == kTimecode) {
        timecode_column_ = column;
      } else if (plain == kTimestamp) {
        notes_.push_back(note_on_timestamp(std::string(name)));
      } else if (holds_frame_numbers(plain)) {
        frame_column_ = column;
      } else if (plain == kBlendshapeCount) {
        count_column_ = column;
      } else {
        weight_columns_.push_back(column);
      }
    }
    if (weight_columns_.empty()) csv_.fail("no column of weights");
  }

  /// Seconds precede milliseconds.
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
    if (is_lost && count_column_ && !is_missing(*count_column_) &&
        csv_.number(*count_column_) > 0 && !csv_.is_given(weight_columns_.back())) {
      csv_.fail("is cut off: it has no weights of the " + std::string(csv_.field(*count_column_)) +
                " that it counts");
    }
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

  /// A column with anything but whole numbers is not used.
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
      csv_.fail("expected a timecode HH:MM:SS:FF, found '" + std::string(text) + "'" +
                (text.find(';') == std::string_view::npos
                     ? ""
                     : ", a drop-frame timecode; give seconds in a column 'time' instead"));
    }
    if (!timecodes_.empty() && !passes(timecodes_.back(), *code)) {
      csv_.fail("the timecode " + std::string(text) +
                " is not later than the one before; leave out one of the rows, or the column");
    }
    timecodes_.push_back(*code);
  }

  /// Computes times from all timecodes together.
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

  /// Throws IoError if a column has no number.
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
  int first_line_ = 0;                     ///< of the first row of weights
  std::vector<std::string> first_fields_;  ///< first row, in the columns of weights
  std::optional<std::size_t> time_column_, timecode_column_, frame_column_, count_column_;
  double units_per_second_ = 1;
  std::vector<long long> frame_numbers_;
  std::vector<std::size_t> weight_columns_;
  std::vector<double> weights_;
  std::vector<double> times_;
  std::vector<Timecode> timecodes_;
  std::vector<std::string> notes_;
  std::string frame_note_;  ///< note on frame numbers that are not used
  int frames_ = 0;
};

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
  const std::string kind(kind_of_file(path));
  if (!kind.empty() && !is_json && extension != ".csv") {
    throw IoError(path.string(),
                  "is " + kind + "; weights are read from .csv with a line of names, or .json");
  }
  WeightTrack track = is_json ? read_weights_json(path) : WeightReader(path).read();
  fill_missing_weights(track);
  note_odd_times(track);
  return track;
}

void write_weights(const std::filesystem::path& path, const WeightTrack& track, bool overwrite) {
  check_sizes(track);
  const bool timed = track.times.size() > 0;
  std::string text = timed ? "time" : "";
  for (const std::string& name : track.names) text += (text.empty() ? "" : ",") + csv_field(name);
  text += '\n';
  for (Eigen::Index f = 0; f < track.weights.rows(); ++f) {
    if (timed) append_number(text, track.times[f]);
    for (Eigen::Index j = 0; j < track.weights.cols(); ++j) {
      if (timed || j > 0) text += ',';
      append_number(text, track.weights(f, j));
    }
    text += '\n';
  }
  write_file(path, text, overwrite);
}

}  // namespace mimetra
