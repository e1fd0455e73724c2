#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "fitting/followed_face.h"
#include "fitting/landmark_formats.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/time_columns.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Keys for the faces of a frame: ours, and those of MediaPipe's interfaces.
constexpr std::array kFaceKeys = {"points",    "faceLandmarks",      "face_landmarks",
                                  "landmarks", "multiFaceLandmarks", "multi_face_landmarks",
                                  "landmark"};

constexpr std::array kRateKeys = {"fps", "frame_rate", "frameRate"};

bool has_coordinates(const Json& value) {
  return value.is_object() && value.contains("x") && value.contains("y");
}

bool is_list_of_coordinates(const Json& value) {
  return value.is_array() && (value.size() == 2 || value.size() == 3);
}

/// Whether a value is one point, [x, y] or {"x", "y"}. Empty if it is null, or a list of two or
/// three nulls, which may be coordinates or points.
std::optional<bool> is_point(const Json& value) {
  if (value.is_null()) return {};
  if (!value.is_array()) return has_coordinates(value);
  const auto seen = std::ranges::find_if_not(value, &Json::is_null);
  if (seen != value.end()) return seen->is_primitive();
  if (is_list_of_coordinates(value)) return {};
  return false;
}

/// Decides by the first entry that clearly is or is not a point; true if there is none.
bool are_points(const Json& list) {
  for (const Json& entry : list) {
    if (const auto known = is_point(entry)) return *known;
  }
  return true;
}

class JsonReader {
 public:
  explicit JsonReader(const std::filesystem::path& path)
      : path_(path.string()), root_(read_json(path)) {}

  LandmarkTrack read() {
    if (root_.is_object() && root_.contains("frames")) {
      read_frames(root_["frames"], "/frames");
    } else if (root_.is_array() && !are_points(root_)) {
      read_frames(root_, "");
    } else {
      read_frame(root_, "");
    }
    return track();
  }

 private:
  using Points = std::vector<double>;

  [[noreturn]] void fail(const std::string& place, const std::string& message) const {
    throw IoError(path_, (place.empty() ? "/" : place) + ": " + message);
  }

  double number(const Json& value, const std::string& place) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(place, "expected a finite number");
    }
    return value.get<double>();
  }

  void read_frames(const Json& frames, const std::string& place) {
    if (!frames.is_array() || frames.empty()) fail(place, "expected a list of frames");
    for (std::size_t f = 0; f < frames.size(); ++f) {
      read_frame(frames[f], place + '/' + std::to_string(f));
    }
  }

  void read_frame(const Json& frame, const std::string& place) {
    add_faces(frame, place, faces_.emplace_back());
    if (!frame.is_object()) return;
    bool has_time = false;
    for (const auto& [key, value] : frame.items()) {
      const std::string entry = place + '/' + key;
      if (lower_case(key) == "timestamp") {
        fail(entry, "in which unit? call it \"time\" for seconds, or \"timestamp_ms\"");
      }
      if (const auto units = units_per_second(key); units && !has_time) {
        read_time(number(value, entry) / *units, entry);
        has_time = true;
      } else if (holds_frame_numbers(key)) {
        read_frame_number(value, frame_numbers_[key]);
      }
    }
    if (frame.contains("confidence")) {
      const double confidence = number(frame["confidence"], place + "/confidence");
      if (!(confidence >= 0 && confidence <= 1)) fail(place + "/confidence", "is outside [0, 1]");
      confidences_.push_back(confidence);
    }
  }

  void read_time(double time, const std::string& place) {
    if (!times_.empty() && time <= times_.back()) fail(place, "times do not ascend");
    times_.push_back(time);
  }

  /// Accepts whole numbers such as 1.0, as pandas writes them.
  static void read_frame_number(const Json& value, std::vector<long long>& numbers) {
    const auto number = value.is_number() ? frame_number(value.get<double>()) : std::nullopt;
    if (number) numbers.push_back(*number);
  }

  /// Adds all faces of a frame, or of a part of it, that have a visible landmark.
  void add_faces(const Json& value, const std::string& place, std::vector<Points>& faces) {
    if (value.is_object()) {
      for (const char* key : kFaceKeys) {
        if (value.contains(key)) return add_faces(value[key], place + '/' + key, faces);
      }
      fail(place, "expected a list of \"points\", or MediaPipe's \"faceLandmarks\"");
    }
    if (value.is_null() || (value.is_array() && value.empty())) return;
    if (!value.is_array()) fail(place, "expected a list of points [x, y]");
    if (are_points(value)) {
      Points points = points_of(value, place);
      const auto is_seen = [](double coordinate) { return !std::isnan(coordinate); };
      if (std::ranges::any_of(points, is_seen)) faces.push_back(std::move(points));
      return;
    }
    for (std::size_t face = 0; face < value.size(); ++face) {
      add_faces(value[face], place + '/' + std::to_string(face), faces);
    }
  }

  Points points_of(const Json& list, const std::string& place) {
    if (landmarks_ == 0) landmarks_ = list.size();
    if (list.size() != landmarks_) {
      fail(place, std::to_string(list.size()) + " points, expected " + std::to_string(landmarks_) +
                      " as in the first frame");
    }
    Points points;
    for (std::size_t i = 0; i < list.size(); ++i) {
      read_point(list[i], place + '/' + std::to_string(i), points);
    }
    return points;
  }

  /// Reads x and y and ignores a depth.
  void read_point(const Json& point, const std::string& place, Points& points) const {
    if (point.is_null()) {
      points.insert(points.end(), 2, kUnseen);
    } else if (has_coordinates(point)) {
      read_coordinates(point["x"], point["y"], place + "/x", place + "/y", points);
    } else if (is_list_of_coordinates(point)) {
      read_coordinates(point[0], point[1], place, place, points);
    } else {
      fail(place, "expected [x, y] or null");
    }
  }

  /// Both are null for a point that was not seen.
  void read_coordinates(const Json& x, const Json& y, const std::string& place_of_x,
                        const std::string& place_of_y, Points& points) const {
    const bool is_seen = !x.is_null() || !y.is_null();
    points.push_back(is_seen ? number(x, place_of_x) : kUnseen);
    points.push_back(is_seen ? number(y, place_of_y) : kUnseen);
  }

  static FaceBox box_of(const Points& points) {
    using Seen = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>;
    return box_around(Seen(points.data(), static_cast<Eigen::Index>(points.size() / 2), 2));
  }

  FollowedFace followed() const {
    std::vector<std::vector<FaceBox>> boxes;
    for (const auto& faces : faces_) {
      std::ranges::transform(faces, std::back_inserter(boxes.emplace_back()), box_of);
    }
    return followed_face(boxes);
  }

  /// Notes frames with several faces, and the choice among them.
  void note_faces(const FollowedFace& followed, std::vector<std::string>& notes) const {
    std::vector<int> several, others;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].size() > 1) several.push_back(static_cast<int>(f));
      if (!faces_[f].empty() && followed.chosen[f] < 0) others.push_back(static_cast<int>(f));
    }
    const auto add = [&](const std::string& what, const std::vector<int>& frames) {
      if (frames.empty()) return;
      notes.push_back(std::to_string(frames.size()) + " of " + std::to_string(faces_.size()) +
                      " frames " + what + ": " + listed(words_of(frames)));
    };
    add("have several faces, of which the largest of the first frame with a face is followed",
        several);
    add("have only faces of others than the one that is followed, and are taken as not seen",
        others);
    add("have the face that is followed elsewhere than before (is it the same person's?)",
        followed.jumps);
  }

  std::vector<std::string> names() const {
    if (!root_.contains("names")) return numbered_names(landmarks_);
    const Json& list = root_["names"];
    if (!list.is_array() || list.size() != landmarks_) {
      fail("/names", "expected a list of " + std::to_string(landmarks_) + " names");
    }
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (const Json& name : list) {
      if (!name.is_string()) fail("/names", "expected strings");
      names.push_back(name.get<std::string>());
      if (!seen.insert(names.back()).second) {
        fail("/names", "the name '" + names.back() + "' occurs twice");
      }
    }
    return names;
  }

  Frames points(const std::vector<int>& chosen) const {
    Frames points(static_cast<Eigen::Index>(faces_.size()),
                  static_cast<Eigen::Index>(2 * landmarks_));
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      auto row = points.row(static_cast<Eigen::Index>(f));
      if (chosen[f] < 0) {
        row.setConstant(kUnseen);
      } else {
        const Points& face = faces_[f][static_cast<std::size_t>(chosen[f])];
        row = Eigen::Map<const Eigen::RowVectorXd>(face.data(), row.size());
      }
    }
    return points;
  }

  /// One number for each frame, or none.
  Eigen::VectorXd of_frames(const std::vector<double>& values, const std::string& name) const {
    if (!values.empty() && values.size() != faces_.size()) {
      fail("/frames", "\"" + name + "\" is in " + std::to_string(values.size()) + " of " +
                          std::to_string(faces_.size()) + " frames, expected it in all or in none");
    }
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  }

  /// Frames per second in the file; 0 if it has none.
  double rate() const {
    for (const char* key : kRateKeys) {
      if (!root_.is_object() || !root_.contains(key)) continue;
      const double fps = number(root_[key], std::string("/") + key);
      if (!(fps > 0)) fail(std::string("/") + key, "expected more than 0");
      return fps;
    }
    return 0;
  }

  /// Ascending numbers of all frames under the first such key; empty, with a note, if none has
  /// them.
  std::vector<long long> frame_numbers(std::vector<std::string>& notes) const {
    for (const auto& [key, numbers] : frame_numbers_) {
      const bool rise =
          std::ranges::adjacent_find(numbers, std::ranges::greater_equal()) == numbers.end();
      if (rise && numbers.size() == faces_.size()) return numbers;
    }
    if (!frame_numbers_.empty()) {
      notes.push_back(note_on_frame_numbers(frame_numbers_.begin()->first));
    }
    return {};
  }

  LandmarkTrack track() const {
    if (landmarks_ == 0) fail("", "shows no face in any frame; expected a list of points");
    const FollowedFace person = followed();
    LandmarkTrack track = {names(), points(person.chosen), of_frames(times_, "time"),
                           of_frames(confidences_, "confidence")};
    note_faces(person, track.notes);
    if (track.times.size() > 0) return track;
    const std::vector<long long> numbers = frame_numbers(track.notes);
    if (const double fps = rate(); fps > 0) {
      track.times = times_at_rate(fps, track.frames(), numbers);
    } else {
      number_frames(track, numbers);
    }
    return track;
  }

  std::string path_;
  Json root_;
  std::size_t landmarks_ = 0;
  std::vector<std::vector<Points>> faces_;  ///< faces of each frame
  std::vector<double> times_, confidences_;
  std::map<std::string, std::vector<long long>> frame_numbers_;  ///< by key, as "frame"
};

}  // namespace

LandmarkTrack read_landmark_json(const std::filesystem::path& path) {
  return JsonReader(path).read();
}

}  // namespace mimetra
