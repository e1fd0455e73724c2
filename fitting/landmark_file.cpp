#include "fitting/landmark_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "fitting/landmark_formats.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/csv.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Throws IoError if a landmark is too far away to be in an image or near it.
void check_places(const std::string& path, const LandmarkTrack& track) {
  constexpr double kFarthest = 1e7;  // pixels; the largest images have a million in a row
  for (Eigen::Index f = 0; f < track.points.rows(); ++f) {
    for (Eigen::Index i = 0; i < track.points.cols(); ++i) {
      const double found = track.points(f, i);
      if (std::isnan(found) || std::abs(found) <= kFarthest) continue;
      throw IoError(path, "frame " + std::to_string(f) + ": " + (i % 2 == 0 ? "x" : "y") +
                              " of landmark '" + track.names[static_cast<std::size_t>(i / 2)] +
                              "' is " + readable(found) +
                              ", expected a place in an image, in pixels; leave out the landmark "
                              "where it was not seen");
    }
  }
}

LandmarkTrack read_pts(const std::filesystem::path& path) {
  const std::string name = path.string(), bytes = read_file(path);
  TextCursor text(name, without_byte_order_mark(bytes), {});
  const auto expect = [&](std::string_view expected) {
    const std::string_view found = text.word_anywhere();
    if (found != expected) text.fail_expected("'" + std::string(expected) + "'", found);
  };
  expect("version:");
  expect("1");
  expect("n_points:");
  const long long count = text.integer(text.word(), "the number of points");
  if (count < 1 || static_cast<std::size_t>(count) > text.left()) {
    text.fail("n_points is " + std::to_string(count) + ", expected the number of the points below");
  }
  expect("{");
  LandmarkTrack track;
  track.names = numbered_names(static_cast<std::size_t>(count));
  track.points.resize(1, 2 * count);
  for (Eigen::Index i = 0; i < 2 * count; ++i) {
    const double value = text.number(text.word_anywhere(), i % 2 == 0 ? "x" : "y");
    if (!std::isfinite(value)) text.fail("a coordinate is not finite");
    track.points(0, i) = value - 1;  // the first pixel is 1
  }
  expect("}");
  text.expect_end();
  return track;
}

/// Column of OpenFace with seconds, in lower case.
constexpr const char* kOpenFaceTime = "timestamp";

/// Number of a column such as x7 or x_7, if `letter` is 'x'.
std::optional<std::size_t> landmark_number(std::string_view name, char letter) {
  if (name.empty() || name.front() != letter) return {};
  name.remove_prefix(name.starts_with(std::string{letter, '_'}) ? 2 : 1);
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return {};
  return number;
}

/// Shortest digits that read back as the same number.
std::string shortest_digits(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

class LandmarkReader {
 public:
  explicit LandmarkReader(const std::filesystem::path& path) : path_(path), csv_(path) {}

  LandmarkTrack read() {
    choose_columns();
    while (csv_.next_row()) read_row();
    if (frames_ == 0) throw IoError(path_.string(), "has column names but no frame");
    return track();
  }

 private:
  void choose_columns() {
    const auto& names = csv_.names();
    std::map<std::size_t, std::size_t> x, y;
    for (std::size_t column = 0; column < names.size(); ++column) {
      const std::string name(names[column]), plain = lower_case(name);
      if (const auto number = landmark_number(name, 'x')) {
        add_column(x, *number, column);
      } else if (const auto row = landmark_number(name, 'y')) {
        add_column(y, *row, column);
      } else if (const auto units = plain == kOpenFaceTime ? 1 : units_per_second(name)) {
        if (!time_) time_ = {column, *units};
      } else if (holds_frame_numbers(plain)) {
        frame_ = column;
      } else if (plain == "confidence") {
        confidence_ = column;
      } else if (plain == "success") {
        success_ = column;
      }
    }
    if (x.empty())
      csv_.fail("no landmarks; expected columns x0, y0, x1, ... or x_0, ..., y_0, ...");
    const std::size_t first = x.begin()->first == 1 ? 1 : 0;
    for (const auto& [number, column] : x) {
      const std::size_t expected = first + columns_.size() / 2;
      if (number != expected) {
        csv_.fail("column 'x" + std::to_string(expected) + "' is missing before '" +
                  std::string(names[column]) + "'");
      }
      const auto found = y.find(number);
      if (found == y.end()) csv_.fail("no column 'y' for '" + std::string(names[column]) + "'");
      columns_.insert(columns_.end(), {column, found->second});
    }
    if (y.size() != x.size()) csv_.fail("there are more columns of y than of x");
  }

  void add_column(std::map<std::size_t, std::size_t>& columns, std::size_t number,
                  std::size_t column) const {
    if (!columns.emplace(number, column).second) {
      csv_.fail("the column '" + std::string(csv_.names()[column]) + "' occurs twice");
    }
  }

  double coordinate(std::size_t column) const {
    const std::string_view field = csv_.field(column);
    return field.empty() || field == "nan" || field == "NaN" ? kUnseen : csv_.number(column);
  }

  void read_row() {
    const bool seen = !success_ || csv_.number(*success_) != 0;
    for (std::size_t i = 0; i < columns_.size(); i += 2) {
      const double x = coordinate(columns_[i]), y = coordinate(columns_[i + 1]);
      if (std::isnan(x) != std::isnan(y)) {
        csv_.fail("only one of '" + std::string(csv_.names()[columns_[i]]) + "' and '" +
                  std::string(csv_.names()[columns_[i + 1]]) + "' is a number");
      }
      points_.insert(points_.end(), {seen ? x : kUnseen, seen ? y : kUnseen});
    }
    if (time_) {
      const double time = csv_.number(time_->column) / time_->units_per_second;
      if (!times_.empty() && time <= times_.back()) {
        csv_.fail("times do not ascend; expected one face and one row a frame");
      }
      times_.push_back(time);
    }
    if (frame_ && !time_) read_frame_number(*frame_);
    if (confidence_) {
      const double confidence = csv_.number(*confidence_);
      if (!(confidence >= 0 && confidence <= 1)) csv_.fail("the confidence is outside [0, 1]");
      confidences_.push_back(confidence);
    }
    ++frames_;
  }

  /// Ignores a column that does not hold numbers, such as names of images.
  void read_frame_number(std::size_t column) {
    const auto number = frame_number_in(csv_.field(column));
    if (!number) {
      notes_.push_back(note_on_frame_numbers(std::string(csv_.names()[column])));
      frame_.reset();
      frame_numbers_.clear();
      return;
    }
    if (!frame_numbers_.empty() && *number <= frame_numbers_.back()) {
      csv_.fail("frame " + std::to_string(*number) + " follows " +
                std::to_string(frame_numbers_.back()) +
                "; expected one face and one row a frame, or a column 'time'");
    }
    frame_numbers_.push_back(*number);
  }

  LandmarkTrack track() const {
    const auto vector = [](const std::vector<double>& values) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size())));
    };
    const auto columns = static_cast<Eigen::Index>(columns_.size());
    LandmarkTrack track = {numbered_names(columns_.size() / 2),
                           Eigen::Map<const Frames>(points_.data(), frames_, columns),
                           vector(times_), vector(confidences_)};
    track.notes = notes_;
    number_frames(track, frame_numbers_);
    return track;
  }

  std::filesystem::path path_;
  CsvReader csv_;
  /// Columns of x0, y0, x1, y1, ...
  std::vector<std::size_t> columns_;
  struct TimeColumn {
    std::size_t column;
    double units_per_second;
  };
  std::optional<TimeColumn> time_;
  std::optional<std::size_t> frame_, confidence_, success_;
  std::vector<long long> frame_numbers_;
  std::vector<double> points_, times_, confidences_;
  std::vector<std::string> notes_;
  Eigen::Index frames_ = 0;
};

}  // namespace

void number_frames(LandmarkTrack& track, const std::vector<long long>& numbers) {
  RowNumbers found = row_numbers(numbers);
  track.step = static_cast<double>(found.step);
  if (!found.note.empty()) track.notes.push_back(std::move(found.note));
}

LandmarkTrack read_landmarks(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  LandmarkTrack track;
  if (extension == ".pts") {
    track = read_pts(path);
  } else if (extension == ".csv") {
    track = LandmarkReader(path).read();
  } else if (extension == ".json") {
    track = read_landmark_json(path);
  } else {
    throw IoError(path.string(),
                  "is not a known format of landmarks; expected .pts, .csv or .json");
  }
  name_mediapipe_landmarks(track);
  check_places(path.string(), track);
  return track;
}

std::string landmark_csv(const LandmarkTrack& track) {
  LandmarkTrack numbered{numbered_names(track.names.size()), {}, {}, {}};
  name_mediapipe_landmarks(numbered);
  if (track.names != numbered.names) {
    throw MismatchError("the landmarks have names, such as '" + track.names.front() +
                        "'; a CSV file numbers them");
  }
  const bool has_times = track.times.size() > 0, has_confidence = track.confidence.size() > 0;
  std::string text = has_times ? "time," : "";
  if (has_confidence) text += "confidence,";
  for (int i = 0; i < track.landmarks(); ++i) {
    const std::string number = std::to_string(i);
    text += (i > 0 ? ",x" : "x") + number + ",y" + number;
  }
  for (Eigen::Index f = 0; f < track.points.rows(); ++f) {
    text += '\n';
    if (has_times) text += shortest_digits(track.times[f]) + ',';
    if (has_confidence) text += shortest_digits(track.confidence[f]) + ',';
    for (Eigen::Index i = 0; i < track.points.cols(); ++i) {
      const double value = track.points(f, i);
      if (i > 0) text += ',';
      if (!std::isnan(value)) text += shortest_digits(value);
    }
  }
  return text + '\n';
}

}  // namespace mimetra
