#include "toolkit/operations/heads.h"

#include <algorithm>

#include "toolkit/io/landmark_vertices.h"
#include "toolkit/io/model_file.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// Where a value was read; empty for one that was made.
fs::path place_of(const NamedData& value) {
  if (!value.origin.path.empty()) return value.origin.path;
  std::error_code unreadable;
  return fs::exists(value.name, unreadable) ? fs::path(value.name) : fs::path();
}

LandmarkVertices landmarks_beside(const fs::path& place, int vertices, const Log& log) {
  std::vector<fs::path> files = landmark_mappings(place);
  // Of several, that of the 68 counts.
  std::stable_partition(files.begin(), files.end(),
                        [](const fs::path& file) { return file.filename() == "landmarks68.txt"; });
  if (files.empty()) return {};
  LandmarkVertices landmarks = ibug_landmarks(read_landmark_mapping(files.front()));
  const auto is_beyond = [vertices](const auto& each) { return each.second >= vertices; };
  const auto beyond = std::ranges::find_if(landmarks, is_beyond);
  if (beyond == landmarks.end()) return landmarks;
  if (log) {
    log(LogLevel::warning, files.front().string() + ": names vertex " +
                               std::to_string(beyond->second) + ", " + place.string() + " has " +
                               std::to_string(vertices) + "; it is of another mesh, and left out");
  }
  return {};
}

}  // namespace

Head head_of(const NamedData& value, const Log& log, bool ignore_files) {
  Head head{value.name, {}};
  if (const auto* sequence = std::get_if<FieldSequence>(&value.data)) {
    head.mesh = {sequence->frames->rest(), sequence->frames->connectivity()};
  } else {
    const BlendshapeModel& person = std::get<ModelData>(value.data).model.average();
    head.mesh = {person.neutral(), person.connectivity()};
  }
  const fs::path place = place_of(value);
  if (!ignore_files && !place.empty()) {
    head.known = landmarks_beside(place, static_cast<int>(head.mesh.positions.rows()), log);
  }
  return head;
}

}  // namespace mimetra
