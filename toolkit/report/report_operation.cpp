#include "toolkit/report/report_operation.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/evaluation_table.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/pictures/render_operation.h"
#include "toolkit/pipeline/memory.h"
#include "toolkit/report/report_page.h"
#include "toolkit/report/viewer_script.h"

namespace mimetra {

namespace {

ReportView view_of(const Parameters& parameters) {
  ReportView view;
  view.yaw = parameters.number("yaw");
  view.pitch = parameters.number("pitch");
  view.z_up = is_z_up(parameters);
  view.unit = parameters.optional_text("unit").value_or("");
  return view;
}

/// Pictures that a run cannot give are refused before anything is computed.
void check_pictures(const Invocation& invocation) {
  const RunRead& run = invocation.get<RunRead>("run");
  const std::string manifest = run.record.manifest.string();
  if (invocation.wants("gallery") && run.invocation->find<RegionData>("regions")) {
    throw MismatchError("--gallery: " + manifest +
                        " is a run by given regions, which have no components");
  }
  if (invocation.wants("table-plot") && !run.invocation->inputs.contains("target")) {
    throw MismatchError("--table-plot: " + manifest + " is a run of " + run.record.operation +
                        ", without a transfer");
  }
}

void draw_wanted(Outcome& outcome, const Invocation& invocation, const ReportStudy& study,
                 const ReportView& view) {
  constexpr int kGalleryColumns = 6;
  const auto add = [&](const char* output, const auto& picture) {
    if (invocation.wants(output)) outcome.outputs[output].push_back({"", picture()});
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
  const ReportView view = view_of(invocation.parameters);
  const ReportStudy found =
      study(invocation.inputs.at("run").front(), invocation.parameters.integers("k"),
            part_of(invocation.progress, 0, 0.6), invocation.log);
  const std::string_view viewer = viewer_script();
  ReportPage page = report_page(found, view, viewer, part_of(invocation.progress, 0.6, 1));
  if (page.viewer_frames == 0) {
    invocation.warn(viewer.empty()
                        ? "the report has no 3D viewer: this mimetra was built without npm"
                        : "the report has no 3D viewer: the mesh is too large for it");
  }
  Outcome outcome;
  draw_wanted(outcome, invocation, found, view);
  Json report = {{"bytes", page.html.size()},
                 {"frames", found.sequence.frames()},
                 {"viewer_frames", page.viewer_frames}};
  if (found.transfer) report.update(Json::parse(table_of(found.transfer->rows).json()));
  outcome.report = report.dump();
  outcome.summary = readable(static_cast<double>(page.html.size()) / 1e6, 3) + " MB, " +
                    std::to_string(page.viewer_frames) + " of " +
                    std::to_string(found.sequence.frames()) + " frames in the 3D viewer\n";
  outcome.outputs["out"].push_back({"", Page{std::move(page.html)}});
  return outcome;
}

/// What drawing takes, measured: OpenGL on a processor, and each vertex of each tile of a sheet.
double drawing_bytes(int vertices, std::int64_t components) {
  constexpr double kOpenGl = 2.5e8;
  constexpr double kVertex = 500;
  constexpr std::int64_t kStripTiles = 35;
  const std::int64_t tiles =
      std::max(kStripTiles, std::min<std::int64_t>(components, kMostInGallery));
  return kOpenGl + kVertex * vertices * static_cast<double>(tiles);
}

/// The decompositions, one after the other, and what is kept: the source, both transfers, and the
/// poses of the viewer.
double memory(const Invocation& invocation) {
  const Invocation& call = *invocation.get<RunRead>("run").invocation;
  const auto& read = call.get<SequenceRead>(call.inputs.contains("source") ? "source" : "sequence");
  const auto& counts = invocation.parameters.integers("k");
  const std::int64_t most =
      std::max<std::int64_t>(main_count(call.parameters), *std::ranges::max_element(counts));
  const double analysis = drawing_bytes(read.sequence.vertices(), most) +
                          analysis_bytes(call, read, static_cast<int>(most));
  if (!call.inputs.contains("target")) return analysis;
  SolveOptions options = solving_parameters().read(call.parameters);
  options.threads = call.threads;
  return analysis + 3 * frame_bytes(read.sequence) +
         3 * solution_bytes(read.sequence, call.get<BlendshapeModel>("target"), options);
}

Operation report_operation() {
  Operation operation;
  operation.name = "report";
  operation.summary = "Show a run as one page for a browser: 3D player, pictures, Table I";
  operation.inputs = {{"run", DataKind::run,
                       "what transfer, evaluate or regions wrote, or a folder with such runs"}};
  operation.outputs = {
      {"out", DataKind::page, "the page, below 10 MB and complete in itself: .html"},
      {"gallery", DataKind::picture, "each component at weight 1, .png", true},
      {"weights-plot", DataKind::picture, "weights over time, .png", true},
      {"table-plot", DataKind::picture, "error and time against the share of triangles, .png",
       true}};
  operation.parameters = view_parameters();
  operation.parameters.insert(
      operation.parameters.begin(),
      {"k", ParameterKind::integer_list, std::vector<std::int64_t>{10, 30, 40},
       "numbers of components in the table, besides the run's own", "", 1});
  operation.parameters.push_back(
      {"unit", ParameterKind::text, {}, "name of the meshes' unit of length"});
  operation.examples = {"report actor_smile/ -o smile.html",
                        "report rois/take.pvd --unit mm -o take.html --gallery components.png"};
  operation.run = run_report;
  operation.memory = memory;
  return operation;
}

}  // namespace

void add_report(OperationTable& table) {
  table.add(
      Writer{DataKind::page, {".html"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, std::get<Page>(data).html);
             }});
  table.add(report_operation());
}

}  // namespace mimetra
