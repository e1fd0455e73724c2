#include "toolkit/correspondence/automatic_markers.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Faces of people differ by up to about 0.15, from a caricature's by 0.25.
constexpr double kDoubtfulResidual = 0.3;
/// With fewer, parts of a face may lack markers.
constexpr std::size_t kFewMarkers = 25;

std::string summary_of(const std::string& name, const FaceLandmarks& face) {
  const std::string count = std::to_string(face.found.size()) + " landmarks of " + name;
  if (face.views == 0) return count + " were known";
  return count + " found, the face in " + std::to_string(face.views_with_face) + " of " +
         std::to_string(face.views) + " views, which agree to " +
         readable(100 * face.mean_spread(), 2) +
         " % of the distance between the eyes' outer corners";
}

}  // namespace

std::vector<std::string> AutomaticMarkers::summary(const std::string& source_name,
                                                   const std::string& target_name) const {
  return {std::to_string(markers.size()) + " markers", summary_of(source_name, source),
          summary_of(target_name, target)};
}

std::vector<std::string> AutomaticMarkers::warnings() const {
  std::vector<std::string> warnings;
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

AutomaticMarkers MarkerSearch::operator()(const Head& target) {
  const auto landmarks_of = [this](Head head, bool are_known, double from, double to) {
    if (!are_known) head.known.clear();
    FaceSearchOptions search = options_;
    search.progress = part_of(options_.progress, from, to);
    return find_landmarks(head, finder_, search);
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
  for (const FaceLandmark& landmark : result.source.found) {
    const auto partner =
        std::ranges::find(result.target.found, landmark.number, &FaceLandmark::number);
    if (partner == result.target.found.end()) continue;
    result.markers.push_back({landmark.vertex, partner->vertex});
    result.landmarks.push_back(landmark.number);
  }
  check_markers(result.markers, source_.mesh.positions, target.mesh.positions);
  result.affine_residual =
      affine_residual(result.markers, source_.mesh.positions, target.mesh.positions);
  return result;
}

AutomaticMarkers automatic_markers(const Head& source, const Head& target,
                                   const LandmarkFinder& finder, const FaceSearchOptions& options) {
  return MarkerSearch(source, finder, options)(target);
}

}  // namespace mimetra
