#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include <mimetra/fitting/landmark_formats.h>
#include <mimetra/io/pending_output.h>
#include <mimetra/io/sequence_file.h>
#include <mimetra/io/text_cursor.h>

namespace mimetra {

namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

using Fields = std::vector<std::string_view>;

/// Number of a column called x7 or x_7, for the letter 'x'.
std::optional<std::size_t> landmark_number(std::string_view name, char letter) {
  if (name.empty() || name.front() != letter) return {};
  name.remove_prefix(name.starts_with(std::string{letter, '_'}) ? 2 : 1);
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return {};
  return number;
}

class CsvReader {
 public:
  explicit CsvReader(const std::filesystem::path& path)
      : path_(path.string()),
        bytes_(read_file(path)),
        text_(path_, without_byte_order_mark(bytes_), {}) {}

  LandmarkTrack read() {
    while (!text_.at_end()) {
      line_ = text_.line();
      const std::string_view line = text_.rest_of_line();
      if (line.empty()) continue;
      if (header_.empty()) {
        read_header(line);
      } else {
        read_row(line);
      }
    }
    if (header_.empty()) throw IoError(path_, "is empty; expected a line of column names");
    if (frames_ == 0) throw IoError(path_, "has column names but no frame");
    return track();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(path_, "line " + std::to_string(line_) + ": " + message);
  }

  void read_header(std::string_view line) {
    header_ = comma_separated(line);
    std::map<std::size_t, std::size_t> x, y;
    for (std::size_t column = 0; column < header_.size(); ++column) {
      const std::string_view name = header_[column];
      if (const auto number = landmark_number(name, 'x')) {
        add_column(x, *number, column);
      } else if (const auto row = landmark_number(name, 'y')) {
        add_column(y, *row, column);
      } else if (name == "time" || name == "timestamp") {
        time_ = column;
      } else if (name == "frame") {
        frame_ = column;
      } else if (name == "confidence") {
        confidence_ = column;
      } else if (name == "success") {
        success_ = column;
      }
    }
    if (x.empty()) fail("no landmarks; expected columns x0, y0, x1, ... or x_0, ..., y_0, ...");
    for (const auto& [number, column] : x) {
      if (number != columns_.size() / 2) {
        fail("column 'x" + std::to_string(columns_.size() / 2) + "' is missing before '" +
             std::string(header_[column]) + "'");
      }
      const auto found = y.find(number);
      if (found == y.end()) fail("no column 'y' for '" + std::string(header_[column]) + "'");
      columns_.insert(columns_.end(), {column, found->second});
    }
    if (y.size() != x.size()) fail("there are more columns of y than of x");
  }

  void add_column(std::map<std::size_t, std::size_t>& columns, std::size_t number,
                  std::size_t column) const {
    if (!columns.emplace(number, column).second) {
      fail("the column '" + std::string(header_[column]) + "' occurs twice");
    }
  }

  double number(const Fields& row, std::size_t column) const {
    const std::string_view field = row[column];
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      fail("column '" + std::string(header_[column]) + "': expected a finite number, found '" +
           std::string(field) + "'");
    }
    return value;
  }

  double coordinate(const Fields& row, std::size_t column) const {
    const std::string_view field = row[column];
    return field.empty() || field == "nan" || field == "NaN" ? kUnseen : number(row, column);
  }

  void read_row(std::string_view line) {
    const Fields row = comma_separated(line);
    if (row.size() != header_.size()) {
      fail(std::to_string(row.size()) + " fields, expected " + std::to_string(header_.size()) +
           " as in the first line");
    }
    const bool seen = !success_ || number(row, *success_) != 0;
    for (std::size_t i = 0; i < columns_.size(); i += 2) {
      const double x = coordinate(row, columns_[i]), y = coordinate(row, columns_[i + 1]);
      if (std::isnan(x) != std::isnan(y)) {
        fail("only one of '" + std::string(header_[columns_[i]]) + "' and '" +
             std::string(header_[columns_[i + 1]]) + "' is a number");
      }
      points_.insert(points_.end(), {seen ? x : kUnseen, seen ? y : kUnseen});
    }
    if (time_) {
      const double time = number(row, *time_);
      if (!times_.empty() && time <= times_.back()) {
        fail("times do not ascend; expected one face and one row a frame");
      }
      times_.push_back(time);
    }
    if (frame_ && !time_) check_frame(number(row, *frame_));
    if (confidence_) {
      const double confidence = number(row, *confidence_);
      if (!(confidence >= 0 && confidence <= 1)) fail("the confidence is outside [0, 1]");
      confidences_.push_back(confidence);
    }
    ++frames_;
  }

  /// Without times, rows are taken for consecutive frames.
  void check_frame(double frame) {
    if (last_frame_ && frame != *last_frame_ + 1) {
      fail("frame " + std::to_string(std::lround(frame)) + " follows " +
           std::to_string(std::lround(*last_frame_)) +
           "; expected consecutive frames, or a column 'time'");
    }
    last_frame_ = frame;
  }

  LandmarkTrack track() const {
    const auto vector = [](const std::vector<double>& values) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size())));
    };
    const auto columns = static_cast<Eigen::Index>(columns_.size());
    return {numbered_names(columns_.size() / 2),
            Eigen::Map<const Frames>(points_.data(), frames_, columns), vector(times_),
            vector(confidences_)};
  }

  std::string path_;
  std::string bytes_;
  TextCursor text_;
  int line_ = 0;
  Fields header_;
  /// Columns of x0, y0, x1, y1, ...
  std::vector<std::size_t> columns_;
  std::optional<std::size_t> frame_, time_, confidence_, success_;
  std::optional<double> last_frame_;
  std::vector<double> points_, times_, confidences_;
  Eigen::Index frames_ = 0;
};

}  // namespace

LandmarkTrack read_landmark_csv(const std::filesystem::path& path) {
  return CsvReader(path).read();
}

}  // namespace mimetra
