#include "toolkit/correspondence/automatic_markers.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Residual of doubtful markers. Faces of people differ by up to about 0.15, and from a caricature
/// by 0.25.
constexpr double kDoubtfulResidual = 0.3;
/// With fewer markers, parts of a face may have none.
constexpr std::size_t kFewMarkers = 25;

std::string summary_of(const std::string& name, const FaceLandmarks& face) {
  const std::string count = std::to_string(face.found.size()) + " landmarks of " + name;
  if (face.views == 0) return count + " were known";
  return count + " found, the face in " + std::to_string(face.views_with_face) + " of " +
         std::to_string(face.views) + " views, which agree to " +
         readable(100 * face.mean_spread(), 2) +
         " % of the distance between the eyes' outer corners";
}

/// End of a walk along edges that always gets nearer to `place`. The walk stays on the same lip or
/// lid.
VertexIndex nearest_by_edges(VertexIndex vertex, const Eigen::Vector3d& place,
                             const TriMesh& mesh) {
  const auto distance = [&](VertexIndex v) {
    return (mesh.positions.row(v).transpose() - place).squaredNorm();
  };
  for (VertexIndex last = -1; last != vertex;) {
    last = vertex;
    for (const auto& triangle : mesh.connectivity.triangles.rowwise()) {
      if ((triangle.array() != last).all()) continue;
      for (const VertexIndex v : triangle) {
        if (distance(v) < distance(vertex)) vertex = v;
      }
    }
  }
  return vertex;
}

using LandmarkPairs = std::vector<std::pair<FaceLandmark, FaceLandmark>>;

LandmarkPairs pairs_of(const FaceLandmarks& source, const FaceLandmarks& target) {
  LandmarkPairs pairs;
  for (const FaceLandmark& landmark : source.found) {
    const auto partner = std::ranges::find(target.found, landmark.number, &FaceLandmark::number);
    if (partner != target.found.end()) pairs.emplace_back(landmark, *partner);
  }
  return pairs;
}

/// Chooses target vertices whose offset from the landmark matches the source's. Of pairs with one
/// target vertex, only the first stays.
void match_vertices(LandmarkPairs& pairs, const Positions& source, const TriMesh& target) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  if (count < kFewestMarkers) return;
  Positions from(count, 3), to(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.row(i) = pairs[i].first.place;
    to.row(i) = pairs[i].second.place;
  }
  const Similarity map = similarity_fit(from, to);
  std::set<VertexIndex> taken;
  for (auto& [a, b] : pairs) {
    const Eigen::Vector3d beside = source.row(a.vertex).transpose() - a.place;
    const Eigen::Vector3d wanted = b.place + map.scale * map.rotation * beside;
    b.vertex = nearest_by_edges(b.vertex, wanted, target);
  }
  std::erase_if(pairs, [&](const auto& pair) { return !taken.insert(pair.second.vertex).second; });
}

}  // namespace

std::vector<std::string> AutomaticMarkers::summary(const std::string& source_name,
                                                   const std::string& target_name) const {
  return {std::to_string(markers.size()) + " markers", summary_of(source_name, source),
          summary_of(target_name, target)};
}

std::vector<std::string> AutomaticMarkers::warnings() const {
  std::vector<std::string> warnings = doubtful;
  if (affine_residual > kDoubtfulResidual) {
    warnings.push_back("the two faces differ by " + readable(100 * affine_residual, 2) +
                       " % of their size beyond what stretching explains; look at the markers");
  }
  if (markers.size() < kFewMarkers) {
    warnings.push_back("only " + std::to_string(markers.size()) +
                       " markers; look at them, and add where a part of the face has none");
  }
  return warnings;
}

std::string landmark_name(int landmark) {
  struct Part {
    int end;
    std::string_view name;
  };
  static constexpr std::array<Part, 9> kParts = {{{17, "jaw"},
                                                  {22, "right brow"},
                                                  {27, "left brow"},
                                                  {31, "bridge of the nose"},
                                                  {36, "nostrils"},
                                                  {42, "right eye"},
                                                  {48, "left eye"},
                                                  {60, "lips"},
                                                  {68, "inside of the lips"}}};
  const auto* part =
      std::ranges::find_if(kParts, [landmark](const Part& each) { return landmark < each.end; });
  return std::string(part->name) + " (landmark " + std::to_string(landmark + 1) + ")";
}

MarkerSearch::MarkerSearch(Head source, LandmarkFinder finder, const FaceSearchOptions& options)
    : source_(std::move(source)), finder_(std::move(finder)), options_(options) {}

AutomaticMarkers MarkerSearch::operator()(const Head& target, const Context& context) {
  const auto landmarks_of = [&](Head head, bool are_known, double from, double to) {
    if (!are_known) head.known.clear();
    return find_landmarks(head, finder_, options_, context.part(from, to));
  };
  const bool are_known = !source_.known.empty() && !target.known.empty();
  AutomaticMarkers result;
  if (are_known) {
    result.source = landmarks_of(source_, true, 0, 0.5);
  } else {
    if (!found_) found_ = landmarks_of(source_, false, 0, 0.5);
    result.source = *found_;
  }
  result.target = landmarks_of(target, are_known, 0.5, 1);
  LandmarkPairs pairs = pairs_of(result.source, result.target);
  if (!are_known) match_vertices(pairs, source_.mesh.positions, target.mesh);
  for (const auto& [a, b] : pairs) {
    result.markers.push_back({a.vertex, b.vertex});
    result.landmarks.push_back(a.number);
  }
  check_markers(result.markers, source_.mesh.positions, target.mesh.positions);
  result.affine_residual =
      affine_residual(result.markers, source_.mesh.positions, target.mesh.positions);
  std::vector<std::string> names;
  for (const int number : result.landmarks) names.push_back(landmark_name(number));
  result.doubtful =
      described(doubtful_markers(result.markers, source_.mesh.positions, target.mesh.positions),
                result.markers, names);
  return result;
}

AutomaticMarkers automatic_markers(const Head& source, const Head& target,
                                   const LandmarkFinder& finder, const FaceSearchOptions& options,
                                   const Context& context) {
  return MarkerSearch(source, finder, options)(target, context);
}

}  // namespace mimetra
