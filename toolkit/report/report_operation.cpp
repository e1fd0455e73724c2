#include "toolkit/report/report_operation.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/format.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/pictures/picture_formats.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/report/report_page.h"
#include "toolkit/report/viewer_data.h"

namespace mimetra {

namespace {

struct ReportCall {
  /// Further numbers of components for the table.
  std::vector<int> counts = {};
  ReportView view = {};

  static constexpr Option kCounts{"counts", &ReportCall::counts, {.minimum = 1}};
};

BoundParameters<ReportCall> report_parameters() {
  BoundParameters<ReportView> view;
  view.add(&ReportView::viewpoint, viewpoint_parameters())
      .add("unit", ReportView::kUnit, "name of the meshes' unit of length");
  BoundParameters<ReportCall> list;
  return list
      .add("k", ReportCall::kCounts,
           "numbers of components in the table, besides the run's own, as in 10,30,40; each costs "
           "a decomposition and a transfer")
      .add(&ReportCall::view, view);
}

/// Refuses pictures that the run cannot give before anything is computed.
void check_pictures(const Invocation& invocation) {
  const RunRead& run = *invocation.input("run").origin.run;
  const std::string manifest = run.record.manifest.string();
  const Parameters& parameters = run.invocation.parameters;
  const bool is_painted = parameters.find("paint") && parameters.is_set("paint");
  if (invocation.wants("gallery") && (is_painted || run.invocation.find<RegionData>("regions"))) {
    throw MismatchError("--gallery: " + manifest +
                        " is a run by given regions, which have no components");
  }
  const bool selects =
      parameters.find("select") && parameters.choice<Selector>("select") == Selector::transfer;
  if (selects && run.record.operation == "regions") {
    throw MismatchError(manifest +
                        " is a run of regions for a transfer; take that of the transfer itself");
  }
  if (invocation.wants("gallery") && selects) {
    throw MismatchError("--gallery: " + manifest +
                        " is a run by regions for a transfer, which have no components");
  }
  if (invocation.wants("table-plot") && !run.invocation.inputs.contains("target")) {
    throw MismatchError("--table-plot: " + manifest + " is a run of " + run.record.operation +
                        ", without a transfer");
  }
}

void draw_wanted(Outcome& outcome, const Invocation& invocation, const ReportStudy& study,
                 const ReportView& view) {
  constexpr int kGalleryColumns = 6;
  const auto add = [&](const char* output, const auto& picture) {
    if (invocation.wants(output)) outcome.outputs[output].push_back({"", Pictures::of(picture())});
  };
  add("gallery", [&] {
    const Components& components = *study.components;
    const auto all = static_cast<std::size_t>(components.count());
    return draw(component_gallery(components, strongest_components(components, all), view,
                                  kGalleryColumns));
  });
  add("weights-plot", [&] {
    const std::vector<Chart> weights = weight_charts(study);
    if (weights.empty()) {
      throw MismatchError("--weights-plot: " + study.run.manifest.string() +
                          " is a run by given regions in vertex space, which has no weights");
    }
    return draw(weights);
  });
  add("table-plot", [&] { return draw(table_charts(*study.transfer, view.unit)); });
}

Outcome run_report(const Invocation& invocation) {
  check_pictures(invocation);
  const ReportCall call = report_parameters().read(invocation.parameters);
  const ReportStudy found =
      study(invocation.input("run"), call.counts, invocation.log, invocation.context.part(0, 0.6));
  const std::string_view viewer = viewer_script();
  ReportPage page =
      report_page(found, call.view, viewer, kLargestReport, invocation.context.part(0.6, 1));
  if (page.viewer_frames == 0) {
    invocation.warn(viewer.empty()
                        ? "the report has no 3D viewer: this mimetra was built without npm"
                        : "the report has no 3D viewer: the mesh is too large for it");
  }
  Outcome outcome;
  draw_wanted(outcome, invocation, found, call.view);
  Json report = {{"bytes", page.html.size()},
                 {"frames", found.sequence.frames()},
                 {"viewer_frames", page.viewer_frames}};
  if (found.transfer) report.update(Json::parse(table_of(found.transfer->rows).json()));
  outcome.report = json_text(report);
  outcome.summary = readable(static_cast<double>(page.html.size()) / 1e6, 3) + " MB, " +
                    std::to_string(page.viewer_frames) + " of " +
                    std::to_string(found.sequence.frames()) + " frames in the 3D viewer\n";
  outcome.outputs["out"].push_back({"", Document{std::move(page.html)}});
  return outcome;
}

/// Measured memory for drawing: OpenGL on a processor, and each vertex of each tile of a sheet.
double drawing_bytes(int vertices, int components) {
  constexpr double kOpenGl = 2.5e8;
  constexpr double kVertex = 500;
  constexpr int kStripTiles = 35;
  const int tiles = std::max(kStripTiles, std::min(components, static_cast<int>(kMostInGallery)));
  return kOpenGl + kVertex * vertices * tiles;
}

/// Memory of the largest decomposition, and of all data that are kept: the source, both transfers,
/// and the poses of the viewer.
double memory(const Invocation& invocation) {
  const Invocation& call = invocation.input("run").origin.run->invocation;
  const NamedData& source = call.input(call.inputs.contains("source") ? "source" : "sequence");
  const MeshSequence& sequence = std::get<FieldSequence>(source.data).sequence();
  const ReportCall report = report_parameters().read(invocation.parameters);
  int most = main_count(call.parameters);
  for (const int count : report.counts) most = std::max(most, count);
  AnalysisOptions of_most = analysis_parameters().read(call.parameters);
  of_most.count = most;
  const double analysis =
      drawing_bytes(sequence.vertices(), most) + analysis_plan(call, sequence, of_most).bytes;
  if (!call.inputs.contains("target")) return analysis;
  const SolveOptions options = solving_parameters().read(call.parameters);
  return analysis + 3 * frame_bytes(sequence) +
         3 * solution_bytes(sequence, call.get<ModelData>("target").model.average(), options,
                            call.context);
}

Operation report_operation() {
  Operation operation;
  operation.name = "report";
  operation.summary = "Show a run as one page for a browser: 3D player, pictures, Table I";
  operation.inputs = {{"run", DataKind::document,
                       "what transfer, evaluate or regions wrote, or a folder with such runs"}};
  operation.inputs.front().run = true;
  operation.outputs = {
      {"out", DataKind::document, "the page, below 10 MB and complete in itself"},
      {"gallery", DataKind::pictures, "each component at weight 1", true},
      {"weights-plot", DataKind::pictures, "weights over time", true},
      {"table-plot", DataKind::pictures, "error and time against the share of triangles", true}};
  operation.outputs.front().extensions = {".html"};
  for (Output& output : operation.outputs) {
    if (output.kind == DataKind::pictures) output.extensions = {".png"};
  }
  operation.parameters = report_parameters().declared();
  operation.examples = {"report actor_smile/ -o smile.html",
                        "report rois/take.pvd --unit mm -o take.html --gallery components.png"};
  operation.run = run_report;
  operation.memory = memory;
  return operation;
}

}  // namespace

void add_report(OperationTable& table) {
  table.add(Format{.name = "page for a browser",
                   .kind = DataKind::document,
                   .extensions = {".html"},
                   .write = write_document});
  table.add(report_operation());
}

}  // namespace mimetra
