#include "fitting/landmark_mapping.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// MediaPipe's landmark for each of iBUG's 1 to 68. The landmarks of the jaw are spread evenly
/// along the face's oval from the height of the eyes to the chin. Both schemes have the same places
/// on eyes, brows, nose and lips.
constexpr std::array<int, kFaceLandmarks> kMediapipeOfIbug = {
    127, 234, 93,  132, 58,  136, 150, 176, 152, 400, 379, 365, 288, 361, 323, 454, 356,  // jaw
    70,  63,  105, 66,  107,                                    // right brow
    336, 296, 334, 293, 300,                                    // left brow
    168, 197, 195, 4,                                           // bridge
    98,  97,  2,   326, 327,                                    // nostrils
    33,  160, 158, 133, 153, 144,                               // right eye
    362, 385, 387, 263, 373, 380,                               // left eye
    61,  40,  37,  0,   267, 270, 291, 321, 405, 17,  181, 91,  // outer lips
    78,  81,  13,  311, 308, 402, 14,  178,                     // inner lips
};

constexpr const char* kMediapipePrefix = "mp";

bool is_mediapipe(const LandmarkTrack& track) {
  return !track.names.empty() && track.names.front() == "mp0";
}

/// MediaPipe's name at or near one of iBUG's 68 landmarks: "mp133" for "40". Empty for other names.
std::optional<std::string> mediapipe_name(std::string_view ibug) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(ibug.data(), ibug.data() + ibug.size(), number);
  const bool is_number = error == std::errc() && end == ibug.data() + ibug.size();
  if (!is_number || number < 1 || number > kMediapipeOfIbug.size()) return {};
  return kMediapipePrefix + std::to_string(kMediapipeOfIbug[number - 1]);
}

/// True for the names "1", "2", ..., which belong to a scheme with as many landmarks.
bool is_numbered(const LandmarkTrack& track) {
  return track.names == numbered_names(track.names.size());
}

bool is_ibug(const LandmarkTrack& track) {
  return is_numbered(track) && track.landmarks() == kFaceLandmarks;
}

std::vector<Eigen::Index> outline_columns(const LandmarkTrack& track,
                                          const LandmarkMapping& mapping) {
  constexpr int kJaw = 17;
  std::vector<Eigen::Index> columns;
  if (!is_ibug(track)) return columns;
  for (Eigen::Index i = 0; i < kJaw; ++i) {
    const std::string& name = track.names[static_cast<std::size_t>(i)];
    const bool known =
        std::ranges::any_of(mapping, [&](const auto& each) { return each.first == name; });
    if (!known) columns.insert(columns.end(), {2 * i, 2 * i + 1});
  }
  return columns;
}

void check_scheme(const std::string& name, const LandmarkTrack& track) {
  if (!is_numbered(track)) return;
  throw MismatchError("the mapping has a landmark '" + name + "', but there are only 1 to " +
                      std::to_string(track.landmarks()) + "; is it for another set of landmarks?");
}

// Ranges of iBUG's numbers: the first, and the one after the last.
constexpr std::pair kRightEye{36, 42}, kLeftEye{42, 48}, kLips{48, 68};

bool is_in(int number, std::pair<int, int> part) {
  return number >= part.first && number < part.second;
}

/// \pre The part has a landmark.
Eigen::RowVector3d middle_of(const Positions& positions, const LandmarkVertices& landmarks,
                             std::pair<int, int> part) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  int count = 0;
  for (const auto& [number, vertex] : landmarks) {
    if (!is_in(number, part)) continue;
    sum += positions.row(vertex);
    ++count;
  }
  return sum / count;
}

}  // namespace

std::vector<std::string> numbered_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= count; ++i) names.push_back(std::to_string(i));
  return names;
}

void name_mediapipe_landmarks(LandmarkTrack& track) {
  if (track.landmarks() != 468 && track.landmarks() != 478) return;
  if (!is_numbered(track)) return;
  for (int i = 0; i < track.landmarks(); ++i) {
    track.names[static_cast<std::size_t>(i)] = kMediapipePrefix + std::to_string(i);
  }
}

MappedLandmarks map_landmarks(const LandmarkTrack& track, const LandmarkMapping& mapping) {
  std::vector<Eigen::Index> columns;
  MappedLandmarks mapped;
  LandmarkMapping used;
  for (const auto& [name, index] : mapping) {
    const std::string known = is_mediapipe(track) ? mediapipe_name(name).value_or(name) : name;
    const auto found = std::ranges::find(track.names, known);
    if (found == track.names.end()) {
      check_scheme(name, track);
      continue;
    }
    const auto landmark = found - track.names.begin();
    columns.insert(columns.end(), {2 * landmark, 2 * landmark + 1});
    mapped.names.push_back(name);
    mapped.vertices.push_back(index);
    used.emplace_back(name, index);
  }
  if (columns.empty()) {
    throw MismatchError("none of the " + std::to_string(track.landmarks()) +
                        " landmarks is in the mapping; the first is '" +
                        (track.names.empty() ? "" : track.names.front()) +
                        "', the mapping's first '" +
                        (mapping.empty() ? "" : mapping.front().first) + "'");
  }
  mapped.points = track.points(Eigen::all, columns);
  mapped.outline = track.points(Eigen::all, outline_columns(track, mapping));
  if (is_ibug(track) || !is_numbered(track)) mapped.ibug = ibug_landmarks(used);
  return mapped;
}

LandmarkVertices landmarks_beside(const std::filesystem::path& model, int vertices) {
  for (const std::filesystem::path& file : landmark_mappings(model)) {
    LandmarkVertices landmarks = ibug_landmarks(read_landmark_mapping(file));
    const auto is_on_model = [vertices](const auto& landmark) {
      return landmark.second >= 0 && landmark.second < vertices;
    };
    if (tell_axes(landmarks) && std::ranges::all_of(landmarks, is_on_model)) return landmarks;
  }
  return {};
}

bool tell_axes(const LandmarkVertices& landmarks) {
  return std::ranges::all_of(std::array{kRightEye, kLeftEye, kLips}, [&](const auto& part) {
    return std::ranges::any_of(landmarks,
                               [&](const auto& landmark) { return is_in(landmark.first, part); });
  });
}

Eigen::Matrix3d looking_ahead(const Positions& neutral, const LandmarkVertices& landmarks) {
  if (!tell_axes(landmarks)) return Eigen::Matrix3d::Identity();
  const Eigen::RowVector3d right_eye = middle_of(neutral, landmarks, kRightEye);
  const Eigen::RowVector3d left_eye = middle_of(neutral, landmarks, kLeftEye);
  const Eigen::RowVector3d lips = middle_of(neutral, landmarks, kLips);
  // Rows are axes of a viewer: right (the face's own left), up, and towards the viewer.
  Eigen::Matrix3d face;
  face.row(0) = (left_eye - right_eye).normalized();
  face.row(2) = face.row(0).cross((left_eye + right_eye) / 2 - lips).normalized();
  face.row(1) = face.row(2).cross(face.row(0));
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  for (int x = 0; x < 3; ++x) {
    for (const int y : {(x + 1) % 3, (x + 2) % 3}) {
      for (const int signs : {0, 1, 2, 3}) {
        Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
        axes(x, 0) = signs & 1 ? -1 : 1;
        axes(y, 1) = signs & 2 ? -1 : 1;
        axes.col(2) = axes.col(0).cross(axes.col(1));
        if ((axes.transpose() * face).trace() > (best.transpose() * face).trace()) best = axes;
      }
    }
  }
  return best;
}

}  // namespace mimetra
