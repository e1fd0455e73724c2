#include "toolkit/io/weight_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/missing_weights.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

// The keys of files in use: ours, Audio2Face's export for ARKit, and plain ones.
const std::vector<std::string> kNames = {"names", "facsNames", "blendShapeNames", "blendshapes"};
const std::vector<std::string> kMatrix = {"weights", "weightMat"};
const std::string kTimes = "times";
const std::vector<std::string> kRate = {"fps", "exportFps"};
const std::vector<std::string> kRows = {"rows", "frames"};

// MediaPipe's Face Landmarker, from JavaScript and Python.
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

  /// What `mimetra fit` wrote.
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

  /// Null where an object has none of these.
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

  /// NaN for null, which is a weight that is missing.
  double weight(const Json& value, const std::string& place) const {
    return value.is_null() ? kMissingWeight : number(value, place);
  }

  /// Each column holds a number.
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

  /// Of a list for each name, {"time": [0, 0.1], "jawOpen": [0, 1]}, or an object of rows' numbers,
  /// {"jawOpen": {"0": 0, "1": 1}}; empty where the file holds something else.
  Json rows_of_columns() const {
    Json rows = Json::array();
    if (!root_.is_object()) return rows;
    std::string first;
    for (const auto& [name, column] : root_.items()) {
      // Times by that name are read for every shape.
      if ((!column.is_array() && !column.is_object()) || name == kTimes) continue;
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
    if (const Json* times = member(root_, {kTimes})) {
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

  /// Objects whose keys are the names of weights, those of the first row; or have them in an object
  /// "weights".
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

  /// A row's time and in how many units it counts a second, seconds before milliseconds; null
  /// where it has none.
  static std::pair<const Json*, double> time_of(const Json& row) {
    if (!row.is_object()) return {nullptr, 1};
    std::pair<const Json*, double> found = {nullptr, 1};
    for (const auto& [key, value] : row.items()) {
      const auto units = units_per_second(key);
      if (units && (!found.first || *units < found.second)) found = {&value, *units};
    }
    return found;
  }

  /// Of the first key that has one.
  std::optional<long long> frame_number_of(const Json& row) {
    for (const auto& [key, value] : row.items()) {
      if (!holds_frame_numbers(key)) continue;
      frame_key_ = key;
      if (!value.is_number()) continue;
      if (const auto number = frame_number(value.get<double>())) return number;
    }
    return {};
  }

  /// The numbers of all rows; none where some have none, which is noted.
  std::vector<long long> numbers_of_all() {
    const bool all_have_one = std::ssize(frame_numbers_) == track_.weights.rows();
    if (frame_key_.empty() || all_have_one) return frame_numbers_;
    track_.notes.push_back(note_on_frame_numbers(frame_key_));
    return {};
  }

  /// MediaPipe's categories of one face, maybe in a list of faces, as an object of names and
  /// weights, without "_neutral", which is no expression; of no face an empty one.
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

}  // namespace

std::string note_on_timestamp(const std::string& name) {
  return "'" + name +
         "' is not used, since it does not say its unit; call it 'time' where it is in seconds";
}

WeightTrack read_weights_json(const std::filesystem::path& path) {
  WeightJson json(path);
  return json.is_fit() ? read_fit(path).performance() : json.read();
}

}  // namespace mimetra
