#include "fitting/landmark_mapping.h"

#include <algorithm>

#include "fitting/head_rotation.h"
#include "fitting/landmark_formats.h"
#include "fitting/mediapipe.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// Numbered landmarks are those of a scheme, which has as many as its largest number.
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

}  // namespace

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

}  // namespace mimetra
