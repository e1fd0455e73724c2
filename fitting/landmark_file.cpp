#include "fitting/landmark_file.h"

#include <cmath>

#include "fitting/landmark_formats.h"
#include "fitting/mediapipe.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Throws IoError for what is no place in an image, nor near one.
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

}  // namespace

std::vector<std::string> numbered_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= count; ++i) names.push_back(std::to_string(i));
  return names;
}

void number_frames(LandmarkTrack& track, const std::vector<long long>& numbers) {
  RowNumbers found = row_numbers(numbers);
  track.step = static_cast<double>(found.step);
  if (!found.note.empty()) track.notes.push_back(std::move(found.note));
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

LandmarkTrack read_landmarks(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  LandmarkTrack track;
  if (extension == ".pts") {
    track = read_pts(path);
  } else if (extension == ".csv") {
    track = read_landmark_csv(path);
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

}  // namespace mimetra
