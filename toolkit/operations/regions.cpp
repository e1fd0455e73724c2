#include <algorithm>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/colors.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

struct RegionsCall {
  RegionChoiceOptions regions = {};
  /// Also write support_k and component_k of each region.
  bool component_fields = false;
  /// Axis for the script for ParaView.
  UpAxis up = UpAxis::y;
  /// Share of the vertices on which regions are found; by default all.
  std::optional<double> simplify = {};
  AnalysisOptions analysis = {};
  SourceOptions source = {};

  static constexpr Option kComponentFields{"component_fields", &RegionsCall::component_fields};
  static constexpr Option kUp{"up", &RegionsCall::up};
  static constexpr Option kSimplify{
      "simplify", &RegionsCall::simplify, {.minimum = 1e-6, .maximum = 1}};
};

const BoundParameters<RegionsCall>& regions_parameters() {
  static const auto list =
      BoundParameters<RegionsCall>()
          .add(&RegionsCall::regions, region_parameters())
          .add("component-fields", RegionsCall::kComponentFields,
               "also write support_k and component_k of each region")
          .add("simplify", RegionsCall::kSimplify,
               "find the regions on this share of the vertices (as the command simplify chooses "
               "them) and measure their discs on all of them; for fine meshes; default all")
          .add("up", RegionsCall::kUp,
               "axis that points up in --paraview's script; the face looks along +z, or -y where z "
               "is up")
          .add(&RegionsCall::analysis, count_parameters())
          .add(&RegionsCall::analysis, analysis_parameters())
          .add(&RegionsCall::source, rest_parameters())
          .add(&RegionsCall::source, alignment_parameters());
  return list;
}

std::vector<Exclusion> regions_exclusions() {
  return concatenated<Exclusion>(
      {{{{"up"}, {"!paraview"}, "is for the script of --paraview"}},
       selection_exclusions(),
       {{{"simplify"}, {"!region=disc"}, "needs --region disc; the others need all vertices"},
        {{"simplify"}, {"select=transfer"}, "has no effect with --select transfer"},
        {{"simplify"},
         {"components"},
         "has no effect on --components, which are decomposed already"},
        {{"component-fields", "components-out"},
         {"simplify"},
         "components of all vertices are not made with --simplify"},
        {{"select=transfer"}, {"!target"}, "needs the target of the transfer, --target MODEL"},
        {{"target", "markers", "index-base", "correspondence"},
         {"!select=transfer"},
         "regions by energy do not depend on a target; use --select transfer"}},
       pairing_exclusions()});
}

struct Found {
  Regions regions;
  /// Empty if components are given.
  std::optional<HeadMotionTaken> head_motion = {};
  /// Components from which the regions come; empty for regions chosen for a transfer.
  std::optional<Components> components = {};
  /// Number of vertices on which the regions were found, if fewer than all.
  std::optional<std::size_t> simplified_vertices = {};
  double seconds = 0;
};

/// Finds regions on some of the vertices.
Found found_on_simplified(const Invocation& invocation, const RegionsCall& call,
                          const Context& context) {
  const Source source = prepare_source(invocation.get<FieldSequence>("sequence").frames,
                                       call.source, {}, context.part(0, 0));
  SimplifiedRegions made = regions_by_simplified(source, {.share = *call.simplify}, call.analysis,
                                                 call.regions, context);
  Found found{std::move(made.regions), source.head_motion};
  found.simplified_vertices = made.mesh.vertices.size();
  found.seconds = made.seconds;
  return found;
}

/// Finds regions by given components, or by components of the sequence without its head motion.
Found found_by_energy(const Invocation& invocation, const RegionsCall& call,
                      const Context& context) {
  if (call.simplify) return found_on_simplified(invocation, call, context);
  const std::shared_ptr<const FrameSource>& sequence =
      invocation.get<FieldSequence>("sequence").frames;
  Found found;
  const auto analysis = [&] {
    if (const auto given = given_components(invocation)) {
      return analysis_of(*given, *sequence, moving_vertices(*sequence), call.analysis, context);
    }
    const Source source = prepare_source(sequence, call.source, {}, context.part(0, 0));
    found.head_motion = source.head_motion;
    return analyse(source, call.analysis, context);
  }();
  found.regions = choose_regions(analysis, call.regions, context.part(1, 1).without_ranks());
  found.components = analysis.components;
  found.seconds = analysis.seconds;
  return found;
}

/// Finds regions by their information about the target's expressions.
Found found_for_transfer(const Invocation& invocation, const RegionsCall& call,
                         const Context& context) {
  const Stopwatch stopwatch;
  const std::shared_ptr<const FrameSource>& sequence =
      invocation.get<FieldSequence>("sequence").frames;
  const Context at_start = context.part(0, 0);
  const MatchedTarget matched(*sequence, targets_of(invocation, "sequence").front(),
                              asked_rest(*sequence, call.source), at_start.without_ranks());
  check_selection(*matched, call.regions, Space::automatic);
  const SolveOptions of_solve{.edges = edge_sum(call.analysis.compatibility)};
  const Source source =
      prepare_source(sequence, call.source, joint_search({*matched}, of_solve), at_start);
  const PlacedSource placed = placed_at(*matched, source, of_solve.axes, at_start);
  RegionSelector selector(source, call.regions, call.analysis);
  Found found{selector(placed.source, *matched, of_solve, context), source.head_motion};
  found.seconds = stopwatch.seconds();
  return found;
}

/// Colour of each region by its number; -1 for vertices outside all regions.
std::map<int, Color> colors_of(const RegionData& regions) {
  const std::vector<Field>& fields = regions.fields.fields;
  const Field& region = *std::ranges::find(fields, "region", &Field::name);
  std::vector<int> labels;
  for (const double value : region.values.reshaped()) labels.push_back(static_cast<int>(value));
  const std::vector<Color> colors = category_colors(labels, regions.fields.frames->triangles());
  std::map<int, Color> by_region = {{-1, kClay}};
  for (std::size_t v = 0; v < labels.size(); ++v) by_region.emplace(labels[v], colors[v]);
  return by_region;
}

/// Returns a string of Python. JSON's escapes are Python's, except for characters beyond 16 bits.
std::string quoted(const std::string& text) {
  return json_text(text);
}

std::string list_of(const Eigen::RowVector3d& point) {
  std::ostringstream text;
  text.precision(9);
  text << '[' << point.x() << ", " << point.y() << ", " << point.z() << ']';
  return text.str();
}

/// Returns `name = value` lines with the colour and name of each value.
std::string categories(const std::map<int, Color>& colors) {
  std::ostringstream names, values;
  values.precision(3);
  for (const auto& [region, color] : colors) {
    const char* separator = region == colors.begin()->first ? "" : ", ";
    names << separator << '"' << region << "\", \""
          << (region < 0 ? "none" : std::to_string(region)) << '"';
    values << separator << color.red / 255.0 << ", " << color.green / 255.0 << ", "
           << color.blue / 255.0;
  }
  return "colors.Annotations = [" + names.str() + "]\ncolors.IndexedColors = [" + values.str() +
         "]\n";
}

/// Returns an orthographic camera, a little from the side and from above.
std::string camera(const Positions& rest, UpAxis up) {
  const auto axes = [up](double right, double above, double front) {
    return up == UpAxis::y ? Eigen::RowVector3d(right, above, front)
                           : Eigen::RowVector3d(right, 0 - front, above);
  };
  const Eigen::RowVector3d low = rest.colwise().minCoeff(), high = rest.colwise().maxCoeff();
  const Eigen::RowVector3d middle = (low + high) / 2;
  const double size = (high - low).norm();
  const Eigen::RowVector3d from = middle + 2 * size * axes(0.26, 0.09, 0.96);
  const Eigen::RowVector3d seen = axes(1, 1, 0).cwiseProduct(high - low);
  std::ostringstream text;
  text << "view.CameraParallelProjection = 1\nview.CameraFocalPoint = " << list_of(middle)
       << "\nview.CameraPosition = " << list_of(from)
       << "\nview.CameraViewUp = " << list_of(axes(0, 1, 0)) << '\n'
       << "view.CameraParallelScale = " << 0.6 * seen.maxCoeff() << '\n';
  return text.str();
}

constexpr const char* kHead = R"(# Regions of a sequence in ParaView:    paraview --script=VIEW.py
# or in a picture, without a window:    pvpython VIEW.py PICTURE.png
import sys

from paraview.simple import *

)";

constexpr const char* kColoring = R"(
view = GetActiveViewOrCreate("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesVisibility = 0
# Without a dark side.
view.FillLightKFRatio = 1.5
view.HeadLightKHRatio = 1.5
# Each face in the colour of the region that most of its points are in: colours do not blend.
faces = PointDatatoCellData(reader, CategoricalData=1, PassPointData=1)
# Without normals the light shows every face. Newer versions name the filter SurfaceNormals.
add_normals = globals().get("SurfaceNormals") or GenerateSurfaceNormals
faces = add_normals(faces, Splitting=0, Consistency=0)
display = Show(faces, view)
ColorBy(display, ("CELLS", "region"))
colors = GetColorTransferFunction("region")
colors.InterpretValuesAsCategories = 1
colors.AnnotationsInitialized = 1
)";

constexpr const char* kLegend = R"(
display.SetScalarBarVisibility(view, True)
legend = GetScalarBar(colors, view)
legend.Title = "region"
legend.ComponentTitle = ""
legend.TitleColor = legend.LabelColor = [0, 0, 0]
legend.WindowLocation = "Any Location"
legend.Position = [0.9, 0.03]
legend.ScalarBarLength = 0.9
legend.TitleFontSize = legend.LabelFontSize = 10

time = AnnotateTimeFilter(reader)
time.Format = "{time:.2f} s"
clock = Show(time, view)
clock.Color = [0, 0, 0]
clock.FontSize = 12
clock.WindowLocation = "Lower Left Corner"
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
SetActiveSource(faces)

Render(view)
)";

constexpr const char* kEnd = R"(Render(view)

if len(sys.argv) == 2 and sys.argv[1].endswith(".png"):
    view.ViewSize = [1280, 800]
    SaveScreenshot(sys.argv[1], view, ImageResolution=view.ViewSize)
)";

/// Returns a script that shows the regions of a written series (.pvd or .vtp) in ParaView
/// (`paraview --script=VIEW.py`). Neighbours have different colours with a legend. The view shows
/// the time, and the face from the front. pvpython draws a picture instead, to a file given after
/// the script.
std::string paraview_view(const RegionData& regions, const std::filesystem::path& series,
                          UpAxis up) {
  const std::string name = series.stem().string();
  return kHead + ("reader = OpenDataFile(" + quoted(series.string()) + ")\n") + "RenameSource(" +
         quoted(name) + ", reader)\n" + kColoring + categories(colors_of(regions)) + kLegend +
         camera(regions.fields.frames->rest(), up) + kEnd;
}

/// Path of the main output, which the script for ParaView opens.
std::filesystem::path series_of(const Invocation& invocation) {
  const auto out = invocation.wanted.find("out");
  if (out != invocation.wanted.end() && !out->second.empty()) {
    const std::filesystem::path& path = out->second.front();
    const std::string extension = lower_extension(path);
    if (extension == ".pvd" || extension == ".vtp") {
      return std::filesystem::absolute(path).lexically_normal();
    }
  }
  throw UsageError("--paraview: needs regions that ParaView opens, with -o NAME.pvd or NAME.vtp");
}

/// Reads the options. Refuses impossible requests before the run.
RegionsCall read_regions_call(const Invocation& invocation) {
  if (invocation.wants("paraview")) series_of(invocation);
  check_given_components(invocation);
  RegionsCall call =
      regions_parameters().read(invocation.parameters, &invocation.get<FieldSequence>("sequence"));
  call.regions = with_most_discs(call.regions, invocation.parameters);
  call.source = described(std::move(call.source), invocation.input("sequence"));
  const Components* given = invocation.find<Components>("components");
  if (call.component_fields && given && given->support.size() == 0) {
    throw MismatchError(invocation.input("components").name +
                        ": holds no support maps, which --component-fields writes; decompose the "
                        "sequence again");
  }
  return call;
}

/// Plan of a decomposition on some of the vertices, with the choice of these vertices.
DecompositionPlan of_share(double share, DecompositionPlan plan, const FrameSource& sequence,
                           const AnalysisOptions& options, const Context& context) {
  // Discs are measured along the whole mesh.
  const double measuring =
      distance_bytes(options.distances.method, sequence.vertices(), options.count, context);
  plan.bytes = std::max({simplify_bytes(sequence), share * plan.bytes, measuring});
  plan.scratch_bytes *= share;
  return plan;
}

DecompositionPlan plan_of_regions(const Invocation& invocation) {
  const FrameSource& sequence = *invocation.get<FieldSequence>("sequence").frames;
  const RegionsCall call = regions_parameters().read(invocation.parameters);
  if (call.regions.select == Selector::energy) {
    const DecompositionPlan plan = analysis_plan(invocation, sequence, call.analysis);
    if (!call.simplify) return plan;
    return of_share(*call.simplify, plan, sequence, call.analysis, invocation.context);
  }
  DecompositionPlan plan;
  if (const auto* target = invocation.find<ModelData>("target")) {
    plan.bytes = selection_bytes(sequence, target->model.average());
  }
  return plan;
}

void foresee_regions(const Invocation& invocation) {
  const RegionsCall call = read_regions_call(invocation);
  const FrameSource& sequence = *invocation.get<FieldSequence>("sequence").frames;
  if (const auto given = given_components(invocation)) check_components(*given, sequence);
  if (call.regions.select != Selector::transfer) return;
  const std::vector<Target> targets = targets_of(invocation, "sequence");
  check_targets(invocation, targets, sequence, {});
  in_command_terms(invocation.parameters,
                   [&] { check_selection(targets.front(), call.regions, Space::automatic); });
}

Outcome run_regions(const Invocation& invocation) {
  const RegionsCall call = read_regions_call(invocation);
  const Context context = within_memory(invocation);
  const Found found = in_command_terms(invocation.parameters, [&] {
    return call.regions.select == Selector::transfer ? found_for_transfer(invocation, call, context)
                                                     : found_by_energy(invocation, call, context);
  });
  const Regions& regions = found.regions;
  std::vector<Field> fields = fields_of(regions);
  if (call.component_fields) {
    for (Field& field : component_fields(*found.components, regions)) {
      fields.push_back(std::move(field));
    }
  }
  Outcome outcome;
  Json json = report_of(regions);
  if (found.head_motion) json["head_motion"] = json_of(*found.head_motion);
  if (found.simplified_vertices) json["simplified_vertices"] = *found.simplified_vertices;
  if (found.components) add_convergence(json, *found.components);
  json["seconds"] = found.seconds;
  outcome.report = json_text(json);
  outcome.summary = summary_of(regions);
  const RegionData shown{regions, FieldSequence(invocation.get<FieldSequence>("sequence").frames,
                                                std::move(fields), true)};
  if (invocation.wants("paraview")) {
    outcome.outputs["paraview"].push_back(
        {"", Document{paraview_view(shown, series_of(invocation), call.up)}});
  }
  outcome.outputs["out"].push_back({"", shown});
  if (invocation.wants("components-out")) {
    outcome.outputs["components-out"].push_back({"", *found.components});
  }
  return outcome;
}

}  // namespace

Operation regions_operation() {
  Operation operation;
  operation.name = "regions";
  operation.summary = "Regions of interest of a sequence, as fields for ParaView";
  operation.inputs = {
      {"sequence", DataKind::sequence, "sequence whose moving regions are looked for"},
      {"components", DataKind::components, "components of an earlier decompose", true},
      {"target", DataKind::model, "who receives the motion, for --select transfer", true}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::regions, "the regions, as .pvd over time"},
                       components_output(),
                       {"paraview", DataKind::document,
                        "script that shows them by paraview --script=VIEW.py", true}};
  operation.outputs.back().extensions = {".py"};
  operation.parameters =
      concatenated<Parameter>({regions_parameters().declared(), pairing_parameters()});
  operation.exclusions = regions_exclusions();
  operation.examples = {"regions takes/ -k 30 -o rois/take.pvd --paraview view.py",
                        "regions take.npy --coverage 0.8 --radius 12abs -o rois.json"};
  operation.measures = region_measures();
  operation.run = run_regions;
  operation.shared = true;
  operation.foresee = foresee_regions;
  operation.memory = [](const Invocation& invocation) { return plan_of_regions(invocation).bytes; };
  operation.scratch = [](const Invocation& invocation) {
    return plan_of_regions(invocation).scratch_bytes;
  };
  return operation;
}

}  // namespace mimetra
