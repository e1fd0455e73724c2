#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

namespace {

struct MarkersCall {
  FaceSearchOptions search = {};
  /// Search for landmarks even if files beside both meshes name their vertices.
  bool ignore_files = false;

  static constexpr Option kIgnoreFiles{"ignore_files", &MarkersCall::ignore_files};
};

BoundParameters<MarkersCall> markers_parameters() {
  BoundParameters<FaceSearchOptions> search;
  search
      .add("max-spread", FaceSearchOptions::kMaxSpread,
           "landmarks on which the views agree less are left out; share of the distance between "
           "the outer corners of the eyes")
      .add("pixels", FaceSearchOptions::kPixels, "width and height of the drawings of a face");
  BoundParameters<MarkersCall> list;
  return list.add(&MarkersCall::search, search)
      .add("ignore-files", MarkersCall::kIgnoreFiles,
           "look for landmarks also where files landmarks68.txt beside both meshes name them");
}

Json json_of(const FaceLandmarks& face) {
  Json landmarks = Json::array();
  for (const FaceLandmark& landmark : face.found) {
    landmarks.push_back({{"landmark", landmark.number + 1},
                         {"vertex", landmark.vertex},
                         {"spread", face.size > 0 ? landmark.spread / face.size : 0},
                         {"views", landmark.views}});
  }
  return {{"known", face.views == 0},
          {"views", face.views},
          {"views_with_face", face.views_with_face},
          {"confidence", face.confidence},
          {"mean_spread", face.mean_spread()},
          {"landmarks", landmarks}};
}

Outcome run_markers(const Invocation& invocation) {
  const MarkersCall call = markers_parameters().read(invocation.parameters);
  const Head source = head_of(invocation.input("source"), invocation.log, call.ignore_files);
  const Head target = head_of(invocation.input("target"), invocation.log, call.ignore_files);
  const AutomaticMarkers found = automatic_markers(source, target, invocation.landmark_finder,
                                                   call.search, invocation.context);
  for (const std::string& warning : found.warnings()) invocation.warn(warning);
  std::vector<std::string> comments;
  for (const int landmark : found.landmarks) comments.push_back(landmark_name(landmark));
  const std::vector<std::string> summary = found.summary(source.name, target.name);
  std::vector<std::string> header = summary;
  header.push_back("vertex of the source, vertex of the target, both counted from 0");
  Outcome outcome;
  outcome.outputs["out"].push_back({"", Document{marker_text(found.markers, comments, header)}});
  Json markers = Json::array();
  for (const Marker& marker : found.markers) markers.push_back({marker.source, marker.target});
  outcome.report = json_text(Json{{"markers", markers},
                                  {"affine_residual", found.affine_residual},
                                  {"source", json_of(found.source)},
                                  {"target", json_of(found.target)}});
  for (const std::string& line : summary) outcome.summary += line + '\n';
  return outcome;
}

}  // namespace

void add_markers(OperationTable& table) {
  Operation operation;
  operation.name = "markers";
  operation.summary = "Find vertices of two heads that are the same point of a face";
  operation.inputs = {{"source", DataKind::sequence, "sequence or mesh of the one head"},
                      {"target", DataKind::model, "model or mesh of the other"}};
  operation.inputs.front().streamed = true;
  operation.outputs = {
      {"out", DataKind::document, "pairs of vertices, to be looked at and edited"}};
  operation.outputs.front().extensions = {".markers"};
  operation.parameters = markers_parameters().declared();
  operation.examples = {"markers take.npy double/ -o take_double.markers",
                        "markers scan.ply actor/ -o scan_actor.markers --max-spread 0.04"};
  operation.run = run_markers;
  table.add(Format{.name = "markers, pairs of vertices",
                   .kind = DataKind::document,
                   .extensions = {".markers"},
                   .write = write_document});
  table.add(std::move(operation));
}

}  // namespace mimetra
