#include "toolkit/pipeline/target.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "toolkit/correspondence/correspondence.h"
#include "toolkit/correspondence/face_openings.h"
#include "toolkit/correspondence/markers.h"
#include "toolkit/correspondence/renumbering.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

TriMesh rest_mesh(const FrameSource& source) {
  return {source.rest(), source.connectivity()};
}

/// Root mean square distance between `from`, fitted without mirroring, and `to` (N x 3).
double misfit(const Positions& from, const Positions& to) {
  const Similarity fit = similarity_fit(from, to, Handedness::kept);
  return (fit.apply(from) - to).norm() / std::sqrt(static_cast<double>(to.rows()));
}

}  // namespace

bool has_faces_of(const TriMesh& source, const BlendshapeModel& target) {
  if (same_faces(source.connectivity, target.connectivity())) return true;
  if (!in_order_of(source.connectivity, target.connectivity())) return false;
  // A mesh that looks the same from two sides has the same faces when it is numbered from the other
  // side.
  const Renumbering other = renumbering(source.connectivity, target.connectivity());
  if (!other.found() || other.moved() == 0) return true;
  return misfit(source.positions, target.neutral()) <
         misfit(source.positions, target.neutral()(other.vertices, Eigen::all));
}

bool is_to_be_paired(const FrameSource& source, const Target& target) {
  if (std::holds_alternative<std::monostate>(target.match)) return false;
  return !std::holds_alternative<MarkersBetween>(target.match) ||
         !has_faces_of(rest_mesh(source), target.model);
}

namespace {

/// Shift, 1 or -1, of vertex numbers that fit much better; 0 if the markers are right.
int better_shift(const std::vector<Marker>& markers, const TriMesh& source, const TriMesh& target) {
  for (const int shift : {1, -1}) {
    if (fit_better_shifted(markers, shift, source.positions, target.positions)) return shift;
  }
  return 0;
}

std::string described_shift(int shift) {
  return std::string("the markers fit much better as vertices one ") +
         (shift > 0 ? "lower: they are counted from 1" : "higher: they are counted from 0");
}

}  // namespace

void check_given_markers(const std::vector<Marker>& markers, const std::vector<std::string>& places,
                         const TriMesh& source, const TriMesh& target, const std::string& name,
                         const Context& context) {
  const int shift = better_shift(markers, source, target);
  try {
    check_markers(markers, source.positions, target.positions);
    // Throws if the markers fit only a mirror image.
    is_inside_out(source, target, markers);
  } catch (const MismatchError& error) {
    const std::string text = name + ": " + error.what();
    if (shift == 0) throw MismatchError(text);
    throw OptionError(Topic::shifted_markers, text + "; " + described_shift(shift));
  }
  if (shift != 0) {
    throw OptionError(Topic::shifted_markers, name + ": " + described_shift(shift));
  }
  const auto doubtful = doubtful_markers(markers, source.positions, target.positions);
  for (const std::string& text : described(doubtful, markers, places)) {
    context.note(name + ": " + text, Topic::poor_match);
  }
}

namespace {

/// Throws MismatchError for a mesh that is only numbered differently.
void check_numbering(const FrameSource& source, const Target& target) {
  const BlendshapeModel& model = target.model;
  const Renumbering found =
      renumbering(rest_mesh(source), TriMesh{model.neutral(), model.connectivity()});
  if (!found.found()) return;
  throw MismatchError(target.name + ": has " + found.summary() +
                      " against the source; write the source in its numbering first "
                      "(convert --match)");
}

/// Describes how faces differ from the source's.
std::string described_faces(const Connectivity& source, const BlendshapeModel& model) {
  if (model.vertices() != source.vertices) {
    return std::to_string(model.vertices()) + " vertices, expected " +
           std::to_string(source.vertices) + " as in the source";
  }
  return "face " + std::to_string(first_different_face(source, model.connectivity())) +
         " is not the source's";
}

/// Finds the correspondence from markers. Errors start with the target's name.
FoundCorrespondence found_by(const std::vector<Marker>& markers, const TriMesh& source,
                             const TriMesh& target, const std::string& name,
                             const Context& context) {
  try {
    FoundCorrespondence found = find_correspondence(source, target, markers, {}, context);
    if (found.inside_out) {
      context.note(name +
                   ": its faces lead the other way round than the source's (one of them "
                   "is inside out); they are paired as if turned; if one was mirrored, left and "
                   "right are exchanged");
    }
    if (found.fit.target_box.is_section) {
      context.note(name +
                   ": the markers span less than a third of the part they are on; "
                   "lengths are measured by the markers' extent");
    }
    return found;
  } catch (const MismatchError& error) {
    throw MismatchError(name + ": " + error.what());
  }
}

/// Size of the parts of a target that have partners; 0 if none has.
double paired_size(const Correspondence& pairs, const TriMesh& target) {
  const Triangles& triangles = target.connectivity.triangles;
  std::vector<VertexIndex> paired;
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    if (pairs.has_partner(t))
      paired.insert(paired.end(), triangles.row(t).begin(), triangles.row(t).end());
  }
  if (paired.empty()) return 0;
  return subject_box(target.positions, surface_parts(target.positions, triangles), paired).diagonal;
}

/// Searches for markers. Notes why they are needed, and warnings about them.
AutomaticMarkers found_between(const MarkersBetween& search, const TriMesh& source,
                               const Target& target, const Context& context) {
  const std::string differs =
      target.name + ": " + described_faces(source.connectivity, target.model.get());
  try {
    AutomaticMarkers found = search(source, context.part(0, 0));
    context.note(differs + "; " + std::to_string(found.markers.size()) +
                 " markers were found on both");
    for (const std::string& warning : found.warnings()) {
      context.note(target.name + ": " + warning, Topic::poor_match);
    }
    return found;
  } catch (const MismatchError& error) {
    throw OptionError(Topic::other_faces, differs + "; " + error.what());
  }
}

/// Notes openings that differ at rest, and openings that only one face has.
void note_openings(const TriMesh& source, const TriMesh& target, const AutomaticMarkers& markers,
                   const std::string& name, const Context& context) {
  for (const OpeningAtRest& opening : openings_at_rest(source, target, markers)) {
    if (!opening.differs()) continue;
    const bool is_sources = opening.source > opening.target;
    context.note(name + ": at rest the " + std::string(opening.name) + " is open by " +
                     percent(opening.target) + " of its width, on the source by " +
                     percent(opening.source) + ": " + (is_sources ? "the source's" : "its") +
                     " rest pose is likely not neutral",
                 is_sources ? Topic::unneutral_rest : Topic::other);
  }
  for (const LoneOpening& opening : lone_openings(source, target, markers)) {
    context.note(
        name + ": the " + std::string(opening.name) + "'s edges were found on the " +
            (opening.is_sources ? "source" : "target") +
            " only; the other's markers there may lie beside them, and what opens and closes it "
            "may be lost: look at them, and give markers of both edges",
        Topic::poor_match);
  }
}

}  // namespace

MatchedTarget::MatchedTarget(const FrameSource& source, Target target,
                             const std::optional<Positions>& source_rest, const Context& context)
    : target_(std::move(target)) {
  const BlendshapeModel& model = target_.model;
  const bool is_given = !std::holds_alternative<std::monostate>(target_.match) &&
                        !std::holds_alternative<MarkersBetween>(target_.match);
  const bool differs = !has_faces_of(rest_mesh(source), model);
  if (differs && !is_given) check_numbering(source, target_);
  if (is_to_be_paired(source, target_)) {
    pair({source_rest.value_or(source.rest()), source.connectivity()}, context);
    return;
  }
  if (differs) {
    const bool same_count = model.vertices() == source.vertices();
    throw OptionError(Topic::other_faces,
                      target_.name + ": " + described_faces(source.connectivity(), model) +
                          (same_count ? "; source and target need the same faces" : ""));
  }
  target_.match = {};
  if (!same_faces(source.connectivity(), model.connectivity())) {
    context.note(target_.name +
                 ": has the source's faces in another order, wound the other way, or "
                 "cut otherwise; they are taken for the same");
  }
  if (model.triangles() == source.triangles()) return;
  auto connectivity = std::make_shared<Connectivity>(model.connectivity());
  if (std::optional<Connectivity> ordered =
          in_order_of(source.connectivity(), model.connectivity())) {
    *connectivity = *std::move(ordered);
  } else {
    connectivity->triangles = source.triangles();
    connectivity->polygon_of_triangle = source.connectivity().polygon_of_triangle;
  }
  target_.model = BlendshapeModel(std::move(connectivity), model.neutral(), model.expressions());
}

void MatchedTarget::pair(const TriMesh& source, const Context& context) {
  const Stopwatch stopwatch;
  const BlendshapeModel& model = target_.model;
  const TriMesh target{model.neutral(), model.connectivity()};
  MatchReport report;
  Correspondence pairs;
  if (const auto* search = std::get_if<MarkersBetween>(&target_.match)) {
    report.found = found_between(*search, source, target_, context);
    note_openings(source, target, *report.found, target_.name, context);
    target_.match = report.found->markers;
  } else if (const auto* given = std::get_if<std::vector<Marker>>(&target_.match)) {
    check_given_markers(*given, target_.marker_places, source, target, target_.name, context);
  }
  if (const auto* markers = std::get_if<std::vector<Marker>>(&target_.match)) {
    FoundCorrespondence found = found_by(*markers, source, target, target_.name, context);
    report.quality = found.quality;
    report.markers = static_cast<int>(markers->size());
    pairs = std::move(found.correspondence);
  } else {
    pairs = std::get<Correspondence>(target_.match);
    report.quality = quality_of(pairs, paired_size(pairs, target));
  }
  if (pairs.parts.empty()) {
    throw MismatchError(target_.name + ": no triangle has a partner in the source");
  }
  target_.pairing = std::make_shared<const Pairing>(source, target, std::move(pairs));
  target_.match = {};
  const std::string verdict = report.quality.verdict();
  if (verdict.starts_with("poor")) {
    context.note(target_.name + ": its correspondence with the source is " + verdict,
                 Topic::poor_match);
  }
  report.seconds = stopwatch.seconds();
  report_ = std::move(report);
}

namespace {

/// Touching lids have vertices about 0.03 of the width apart. Between two heads this differs by
/// less than kStaysOpen.
constexpr double kClosed = 0.06;
constexpr double kStaysOpen = 0.06;

/// Largest differences between faces at rest. Mouths are closed; people's eyes are open by
/// different shares of their width.
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
