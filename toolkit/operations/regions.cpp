#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/command_terms.h"
#include "toolkit/operations/convergence_report.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/measures.h"
#include "toolkit/operations/paraview_view.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/region_report.h"
#include "toolkit/operations/selection_parameters.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/distance_memory.h"
#include "toolkit/pipeline/joint_motion.h"
#include "toolkit/pipeline/memory.h"
#include "toolkit/pipeline/moving_parts.h"
#include "toolkit/pipeline/region_selector.h"
#include "toolkit/pipeline/simplified_regions.h"

namespace mimetra {

namespace {

struct RegionsCall {
  RegionChoiceOptions regions = {};
  /// Also write support_k and component_k of each region.
  bool component_fields = false;
  /// In the script for ParaView.
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

BoundParameters<RegionsCall> regions_parameters(const FieldSequence* fields = nullptr) {
  const FrameSource* sequence = fields ? fields->frames.get() : nullptr;
  BoundParameters<RegionsCall> list;
  return list.add(&RegionsCall::regions, region_parameters())
      .add("component-fields", RegionsCall::kComponentFields,
           "also write support_k and component_k of each region")
      .add("simplify", RegionsCall::kSimplify,
           "find the regions on this share of the vertices (as the command simplify chooses them) "
           "and measure their discs on all of them; for fine meshes; default all")
      .add("up", RegionsCall::kUp,
           "axis that points up in --paraview's script; the face looks along +z, or -y where z is "
           "up")
      .add(&RegionsCall::analysis, count_parameters())
      .add(&RegionsCall::analysis, analysis_parameters(fields))
      .add(&RegionsCall::source, rest_parameters(sequence))
      .add(&RegionsCall::source, alignment_parameters(sequence));
}

struct Found {
  Regions regions;
  /// None where components are given.
  std::optional<HeadMotionTaken> head_motion = {};
  /// That the regions come from; none where they are chosen for a transfer.
  std::optional<Components> components = {};
  /// On which they were found, where those are not all.
  std::optional<std::size_t> simplified_vertices = {};
  double seconds = 0;
};

SourceOptions source_options(const Invocation& invocation, const RegionsCall& call) {
  SourceOptions options = described(call.source, invocation.input("sequence"));
  options.notes = call.analysis.notes;
  options.threads = invocation.threads;
  options.ranks = invocation.ranks;
  return options;
}

/// On some of the vertices.
Found found_on_simplified(const Invocation& invocation, const RegionsCall& call) {
  const Source source = prepare_source(invocation.get<FieldSequence>("sequence").frames,
                                       source_options(invocation, call));
  SimplifiedRegions made =
      regions_by_simplified(source, {.share = *call.simplify}, call.analysis, call.regions);
  Found found{std::move(made.regions), source.head_motion};
  found.simplified_vertices = made.mesh.vertices.size();
  found.seconds = made.seconds;
  return found;
}

/// By components that are given, or those of the sequence without its motion.
Found found_by_energy(const Invocation& invocation, const RegionsCall& call) {
  if (call.simplify) return found_on_simplified(invocation, call);
  const std::shared_ptr<const FrameSource>& sequence =
      invocation.get<FieldSequence>("sequence").frames;
  Found found;
  const auto analysis = [&] {
    if (const auto given = given_components(invocation)) {
      return analysis_of(*given, *sequence, moving_vertices(*sequence), call.analysis);
    }
    const Source source = prepare_source(sequence, source_options(invocation, call));
    found.head_motion = source.head_motion;
    return analyse(source, call.analysis);
  }();
  found.regions = choose_regions(analysis, call.regions);
  found.components = analysis.components;
  found.seconds = analysis.seconds;
  return found;
}

/// By what they tell of the target's expressions.
Found found_for_transfer(const Invocation& invocation, const RegionsCall& call) {
  const Stopwatch stopwatch;
  const std::shared_ptr<const FrameSource>& sequence =
      invocation.get<FieldSequence>("sequence").frames;
  SourceOptions of_source = source_options(invocation, call);
  const MatchedTarget matched(*sequence, targets_of(invocation, "sequence").front(),
                              {.source_rest = asked_rest(*sequence, of_source),
                               .threads = invocation.threads,
                               .notes = of_source.notes});
  check_selection(*matched, call.regions, Space::automatic);
  SolveOptions of_solving;
  of_solving.threads = invocation.threads;
  of_solving.ranks = invocation.ranks;
  of_solving.notes = of_source.notes;
  of_solving.progress = invocation.progress;
  of_solving.edges = edge_sum(call.analysis.compatibility);
  of_source.joint = joint_search({*matched}, of_solving);
  const Source source = prepare_source(sequence, of_source);
  const PlacedSource placed = placed_at(*matched, source, of_solving);
  RegionSelector selector(source, call.regions, call.analysis);
  Found found{selector(placed.source, *matched, of_solving), source.head_motion};
  found.seconds = stopwatch.seconds();
  return found;
}

/// What is not made where regions are found on some of the vertices.
void check_simplify(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  if (!parameters.is_set("simplify")) return;
  if (parameters.choice<RegionShape>("region") != RegionShape::disc) {
    throw UsageError("--simplify: needs --region disc; the others need all vertices");
  }
  if (parameters.choice<Selector>("select") == Selector::transfer) {
    throw UsageError("--simplify: has no effect with --select transfer");
  }
  if (invocation.find<Components>("components")) {
    throw UsageError("--simplify: has no effect on --components, which are decomposed already");
  }
  const std::string reason = "components of all vertices are not made with --simplify";
  refuse_options(parameters, {"component-fields"}, reason);
  if (invocation.wants("components-out")) throw UsageError("--components-out: " + reason);
}

/// Options that the others leave without an effect, or that need more.
void check_choice(const Invocation& invocation) {
  check_selection(invocation);
  check_given_components(invocation);
  check_simplify(invocation);
  const bool selects = invocation.parameters.choice<Selector>("select") == Selector::transfer;
  const bool has_target = invocation.find<ModelData>("target") != nullptr;
  if (selects && !has_target) {
    throw UsageError("--select transfer: needs the target of the transfer, --target MODEL");
  }
  if (selects) return;
  const std::string reason = "regions by energy do not depend on a target; use --select transfer";
  if (has_target) throw UsageError("--target: " + reason);
  refuse_options(invocation.parameters, {"markers", "index-base", "correspondence"}, reason);
}

/// What the script for ParaView opens: the main output.
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

/// Refuses what the run cannot do, before it is done.
RegionsCall read_regions_call(const Invocation& invocation) {
  if (invocation.wants("paraview")) {
    series_of(invocation);
  } else {
    refuse_options(invocation.parameters, {"up"}, "is for the script of --paraview");
  }
  check_choice(invocation);
  RegionsCall call =
      regions_parameters(&invocation.get<FieldSequence>("sequence")).read(invocation.parameters);
  call.regions = with_most_discs(std::move(call.regions), invocation.parameters);
  call.regions.notes = call.analysis.notes = warnings_of(invocation);
  call.analysis.threads = invocation.threads;
  call.analysis.ranks = invocation.ranks;
  call.analysis.progress = invocation.progress;
  const Components* given = invocation.find<Components>("components");
  if (call.component_fields && given && given->support.size() == 0) {
    throw MismatchError(invocation.input("components").name +
                        ": holds no support maps, which --component-fields writes; decompose the "
                        "sequence again");
  }
  return call;
}

/// A decomposition of some of the vertices, and what chooses these.
DecompositionPlan of_share(DecompositionPlan plan, const Invocation& invocation,
                           const FrameSource& sequence) {
  const double share = invocation.parameters.number("simplify");
  plan.bytes = std::max(simplify_bytes(sequence), share * plan.bytes);
  // Discs are measured along the whole mesh.
  if (invocation.parameters.choice<GeodesicMethod>("geodesics") == GeodesicMethod::exact) {
    plan.bytes = std::max(plan.bytes, exact_distance_bytes(sequence.vertices(), invocation.threads,
                                                           invocation.parameters.integer("k")));
  }
  plan.scratch_bytes *= share;
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
  const Found found = in_command_terms(invocation.parameters, [&] {
    return call.regions.select == Selector::transfer ? found_for_transfer(invocation, call)
                                                     : found_by_energy(invocation, call);
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
  operation.parameters = regions_parameters().declared();
  const std::vector<Parameter> matching = pairing_parameters();
  operation.parameters.insert(operation.parameters.end(), matching.begin(), matching.end());
  operation.examples = {"regions takes/ -k 30 -o rois/take.pvd --paraview view.py",
                        "regions take.npy --coverage 0.8 --radius 12abs -o rois.json"};
  operation.measures = region_measures();
  operation.run = run_regions;
  operation.shared = true;
  operation.foresee = foresee_regions;
  const auto plan = [](const Invocation& invocation) {
    const FrameSource& sequence = *invocation.get<FieldSequence>("sequence").frames;
    if (invocation.parameters.choice<Selector>("select") == Selector::energy) {
      DecompositionPlan decomposition =
          analysis_plan(invocation, sequence, invocation.parameters.integer("k"));
      if (invocation.parameters.is_set("simplify"))
        decomposition = of_share(decomposition, invocation, sequence);
      return decomposition;
    }
    DecompositionPlan selection;
    if (const auto* target = invocation.find<ModelData>("target")) {
      selection.bytes = selection_bytes(sequence, target->model.average());
    }
    return selection;
  };
  operation.memory = [plan](const Invocation& invocation) { return plan(invocation).bytes; };
  operation.scratch = [plan](const Invocation& invocation) {
    return plan(invocation).scratch_bytes;
  };
  return operation;
}

}  // namespace mimetra
