#include "toolkit/pipeline/opening_comparison.h"

#include <algorithm>
#include <cmath>

#include "toolkit/correspondence/face_openings.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

namespace {

/// Lids that touch are about 0.03 apart, by the distance of vertices on either; on two heads this
/// differs by less than the second number.
constexpr double kClosed = 0.06;
constexpr double kStaysOpen = 0.06;

/// Mouths at rest are closed; eyes of people are open by different shares of their width.
constexpr double kMouthsAtRest = 0.15, kEyesAtRest = 0.25;

std::vector<FaceOpening> openings_of(const TriMesh& rest, const FaceLandmarks& face) {
  LandmarkVertices landmarks;
  for (const FaceLandmark& landmark : face.found) {
    landmarks.emplace_back(landmark.number, landmark.vertex);
  }
  return face_openings(rest, landmarks);
}

std::vector<FaceOpening> openings_of(const FrameSource& sequence, const FaceLandmarks& face) {
  return openings_of(TriMesh{sequence.rest(), sequence.connectivity()}, face);
}

MeshSequence one_pose(const TriMesh& mesh) {
  const Frames pose = mesh.positions.reshaped<Eigen::RowMajor>().transpose();
  return MeshSequence(mesh.connectivity, pose);
}

}  // namespace

bool OpeningAtRest::differs() const {
  const double most = name == "mouth" ? kMouthsAtRest : kEyesAtRest;
  return std::abs(source - target) > most;
}

std::vector<OpeningAtRest> openings_at_rest(const TriMesh& source, const TriMesh& target,
                                            const AutomaticMarkers& markers) {
  std::vector<OpeningAtRest> at_rest;
  for (const ComparedOpening& opening :
       compared_openings(one_pose(source), one_pose(target), markers)) {
    at_rest.push_back({opening.name, opening.source_least, opening.target_least});
  }
  return at_rest;
}

std::vector<LoneOpening> lone_openings(const TriMesh& source, const TriMesh& target,
                                       const AutomaticMarkers& markers) {
  const std::vector<FaceOpening> of_source = openings_of(source, markers.source),
                                 of_target = openings_of(target, markers.target);
  std::vector<LoneOpening> lone;
  const auto add = [&lone](const auto& some, const auto& others, bool is_sources) {
    for (const FaceOpening& opening : some) {
      if (std::ranges::find(others, opening.name, &FaceOpening::name) != others.end()) continue;
      lone.push_back({opening.name, is_sources});
    }
  };
  add(of_source, of_target, true);
  add(of_target, of_source, false);
  return lone;
}

bool ComparedOpening::stays_open() const {
  return source_least <= kClosed && target_least > source_least + kStaysOpen;
}

std::vector<ComparedOpening> compared_openings(const FrameSource& source, const FrameSource& result,
                                               const AutomaticMarkers& markers,
                                               const Context& context) {
  if (source.frames() != result.frames()) {
    throw MismatchError("the source has " + std::to_string(source.frames()) +
                        " frames, the result " + std::to_string(result.frames()));
  }
  const std::vector<FaceOpening> of_source = openings_of(source, markers.source),
                                 of_target = openings_of(result, markers.target);
  const Eigen::MatrixXd source_is = openness(source, of_source, context.part(0, 0.5)),
                        target_is = openness(result, of_target, context.part(0.5, 1));
  std::vector<ComparedOpening> compared;
  for (std::size_t s = 0; s < of_source.size(); ++s) {
    const auto same = std::ranges::find(of_target, of_source[s].name, &FaceOpening::name);
    if (same == of_target.end()) continue;
    const Eigen::VectorXd from = source_is.col(static_cast<Eigen::Index>(s)),
                          to = target_is.col(same - of_target.begin());
    compared.push_back({of_source[s].name, from.minCoeff(), from.maxCoeff(), to.minCoeff(),
                        to.maxCoeff(), (from - to).cwiseAbs().mean()});
  }
  return compared;
}

}  // namespace mimetra
