#include <mimetra/io/weight_track.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include <mimetra/io/pending_output.h>
#include <mimetra/io/text_cursor.h>
#include <mimetra/mesh/errors.h>

namespace mimetra {

namespace {

using Row = std::vector<std::string_view>;

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// Columns of captures that are not weights.
bool is_bookkeeping(std::string_view name) {
  const std::string plain = lower(name);
  return plain == "frame" || plain == "timecode" || plain == "blendshapecount";
}

class WeightReader {
 public:
  explicit WeightReader(const std::filesystem::path& path)
      : path_(path.string()), text_(read_file(path)) {}

  WeightTrack read() {
    std::string_view rest = without_byte_order_mark(text_);
    while (!rest.empty()) {
      const auto end = rest.find('\n');
      const std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      if (header_.empty())
        read_header(line);
      else
        read_row(line);
    }
    if (header_.empty()) throw IoError(path_, "is empty; expected a line of names");
    if (frames_ == 0) throw IoError(path_, "has names but no row of weights");
    return track();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(path_, "line " + std::to_string(line_) + ": " + message);
  }

  void read_header(std::string_view line) {
    header_ = comma_separated(line);
    if (header_.size() == 1 && line.find(';') != std::string_view::npos) {
      fail("names are separated by ';', expected ','");
    }
    std::set<std::string_view> seen;
    for (std::size_t column = 0; column < header_.size(); ++column) {
      const std::string_view name = header_[column];
      if (name.empty()) fail("column " + std::to_string(column + 1) + " has no name");
      if (!seen.insert(name).second) fail("the name '" + std::string(name) + "' occurs twice");
      if (lower(name) == "time") {
        if (time_column_ >= 0) fail("the name 'time' occurs twice");
        time_column_ = static_cast<int>(column);
      } else if (!is_bookkeeping(name)) {
        weight_columns_.push_back(static_cast<int>(column));
      }
    }
    if (weight_columns_.empty()) fail("no column of weights");
  }

  double number(const Row& row, int column) const {
    const std::string_view field = row[static_cast<std::size_t>(column)];
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      fail("column '" + std::string(header_[static_cast<std::size_t>(column)]) +
           "': expected a finite number, found '" + std::string(field) + "'");
    }
    return value;
  }

  void read_row(std::string_view line) {
    const Row row = comma_separated(line);
    if (row.size() != header_.size()) {
      fail(std::to_string(row.size()) + (row.size() == 1 ? " field" : " fields") + ", expected " +
           std::to_string(header_.size()) + " as in the first line" +
           (row.size() > header_.size() ? " (decimal commas are not supported)" : ""));
    }
    for (const int column : weight_columns_) weights_.push_back(number(row, column));
    if (time_column_ >= 0) {
      const double time = number(row, time_column_);
      if (!times_.empty() && time <= times_.back()) fail("times do not ascend");
      times_.push_back(time);
    }
    ++frames_;
  }

  WeightTrack track() const {
    WeightTrack result;
    const auto columns = static_cast<Eigen::Index>(weight_columns_.size());
    for (const int column : weight_columns_) {
      result.names.push_back(text_of_csv(header_[static_cast<std::size_t>(column)]));
    }
    result.weights = Eigen::Map<const Frames>(weights_.data(), frames_, columns);
    result.times =
        Eigen::Map<const Eigen::VectorXd>(times_.data(), static_cast<Eigen::Index>(times_.size()));
    return result;
  }

  std::string path_;
  std::string text_;
  int line_ = 0;
  Row header_;
  int time_column_ = -1;
  std::vector<int> weight_columns_;
  std::vector<double> weights_;
  std::vector<double> times_;
  int frames_ = 0;
};

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
  std::string result = lower(name);
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
  return WeightReader(path).read();
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
