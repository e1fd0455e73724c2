#include <cmath>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "fitting/landmark_formats.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

class JsonReader {
 public:
  explicit JsonReader(const std::filesystem::path& path)
      : path_(path.string()), root_(read_json(path)) {}

  LandmarkTrack read() {
    if (!root_.is_object()) fail("/", "expected an object with \"frames\" or \"points\"");
    if (!root_.contains("frames")) {
      read_frame(root_, "");
    } else {
      const Json& frames = root_["frames"];
      if (!frames.is_array() || frames.empty()) fail("/frames", "expected a list of frames");
      for (std::size_t f = 0; f < frames.size(); ++f) {
        read_frame(frames[f], "/frames/" + std::to_string(f));
      }
    }
    return track();
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& message) const {
    throw IoError(path_, place + ": " + message);
  }

  double number(const Json& value, const std::string& place) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(place, "expected a finite number");
    }
    return value.get<double>();
  }

  void read_frame(const Json& frame, const std::string& place) {
    if (!frame.is_object() || !frame.contains("points") || !frame["points"].is_array()) {
      fail(place + "/points", "expected a list of points [x, y]");
    }
    const Json& points = frame["points"];
    if (frames_ == 0) landmarks_ = points.size();
    if (landmarks_ == 0 || points.size() != landmarks_) {
      fail(place + "/points", std::to_string(points.size()) + " points, expected " +
                                  (frames_ == 0 ? "some" : std::to_string(landmarks_)) +
                                  (frames_ == 0 ? "" : " as in the first frame"));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      read_point(points[i], place + "/points/" + std::to_string(i));
    }
    if (frame.contains("time")) {
      const double time = number(frame["time"], place + "/time");
      if (!times_.empty() && time <= times_.back()) fail(place + "/time", "times do not ascend");
      times_.push_back(time);
    }
    if (frame.contains("confidence")) {
      const double confidence = number(frame["confidence"], place + "/confidence");
      if (!(confidence >= 0 && confidence <= 1)) fail(place + "/confidence", "is outside [0, 1]");
      confidences_.push_back(confidence);
    }
    ++frames_;
  }

  void read_point(const Json& point, const std::string& place) {
    if (point.is_null()) {
      points_.insert(points_.end(), 2, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    if (!point.is_array() || point.size() != 2) fail(place, "expected [x, y] or null");
    for (const Json& value : point) points_.push_back(number(value, place));
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

  /// One number for each frame, or none at all.
  Eigen::VectorXd of_frames(const std::vector<double>& values, const std::string& name) const {
    if (!values.empty() && values.size() != frames_) {
      fail("/frames", "\"" + name + "\" is in " + std::to_string(values.size()) + " of " +
                          std::to_string(frames_) + " frames, expected it in all or in none");
    }
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  }

  LandmarkTrack track() const {
    return {names(),
            Eigen::Map<const Frames>(points_.data(), static_cast<Eigen::Index>(frames_),
                                     static_cast<Eigen::Index>(2 * landmarks_)),
            of_frames(times_, "time"), of_frames(confidences_, "confidence")};
  }

  std::string path_;
  Json root_;
  std::size_t landmarks_ = 0, frames_ = 0;
  std::vector<double> points_, times_, confidences_;
};

}  // namespace

LandmarkTrack read_landmark_json(const std::filesystem::path& path) {
  return JsonReader(path).read();
}

}  // namespace mimetra
