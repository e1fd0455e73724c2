#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/memory.h"
#include "toolkit/operations/solving.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

/// What becomes of the head motion that was taken out of the source.
enum class RemovedMotion { keep, drop };

constexpr std::string_view choice_name(RemovedMotion value) {
  switch (value) {
    case RemovedMotion::keep:
      return "keep";
    case RemovedMotion::drop:
      return "drop";
  }
  return {};
}

/// The triangles a transfer uses, the regions they come from (none for --full), and the components
/// these come from (none for a region set).
struct Choice {
  Selection selection;
  std::optional<Regions> regions;
  std::optional<Components> components = {};
  double seconds = 0;
};

Choice choose(const Invocation& invocation, const Alignment& source) {
  if (invocation.parameters.flag("full")) {
    return {{all_triangles(source.sequence.triangles()), {}}, {}};
  }
  if (const RegionData* given = invocation.find<RegionData>("regions")) {
    const Regions& regions = given->regions;
    const std::string& name = invocation.inputs.at("regions").front().name;
    const auto triangles = static_cast<int>(source.sequence.triangles().rows());
    if (regions.vertices != source.sequence.vertices() || regions.all_triangles != triangles) {
      throw MismatchError(name + ": regions of a mesh with " + std::to_string(regions.vertices) +
                          " vertices and " + std::to_string(regions.all_triangles) +
                          " triangles, expected " + std::to_string(source.sequence.vertices()) +
                          " and " + std::to_string(triangles) + " as in the source");
    }
    if (regions.triangles.empty()) {
      throw MismatchError(name + ": its regions hold no triangle of the mesh; choose others");
    }
    return {{regions.triangles, regions.inside}, regions};
  }
  const SequenceRead& read = invocation.get<SequenceRead>("source");
  const Stopwatch stopwatch;
  Analysis analysis =
      invocation.find<Components>("components")
          ? analysis_for(invocation, read)
          : analyse(invocation, read, source.sequence, invocation.parameters.integer("k"),
                    part_of(invocation.progress, 0, 0.4));
  Regions regions = regions_of(invocation, analysis);
  Selection selection{regions.triangles, regions.inside};
  return {std::move(selection), std::move(regions), std::move(analysis.components),
          stopwatch.seconds()};
}

NamedData weight_table(const NamedData& target, const Solution& solution) {
  Table table;
  table.columns = {"time"};
  const auto& names = std::get<BlendshapeModel>(target.data).expressions().names;
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  for (int f = 0; f < solution.weights.rows(); ++f) {
    table.rows.push_back({solution.sequence.times()[f]});
    for (const double weight : solution.weights.row(f)) table.rows.back().push_back(weight);
  }
  return {target.name, std::move(table)};
}

Json report_of(const NamedData& target, const Solution& solution, const TransferError& error) {
  Json json = {{"name", target.name},          {"output", nullptr},  {"de_all", error.de_all},
               {"de_region", error.de_region}, {"leak", error.leak}, {"flipped", error.flipped},
               {"seconds", solution.seconds}};
  json["degenerate_source_triangles"] = solution.degenerate_source_triangles;
  json["degenerate_target_triangles"] = solution.degenerate_target_triangles;
  if (solution.weights.size() > 0) {
    json["condition"] = solution.conditions.condition;
    json["unseen"] = solution.conditions.unseen;
    json["weakly_seen"] = solution.conditions.weakly_seen;
  }
  return json;
}

std::string summary_of(const NamedData& target, const Solution& solution,
                       const TransferError& error) {
  return target.name + ": DE " + readable(error.de_all) + " over all triangles, " +
         readable(error.de_region) + " over the regions; leak " + readable(error.leak) + ", " +
         std::to_string(error.flipped) + " flipped triangles; " + readable(solution.seconds) +
         " s\n";
}

/// Refuses outputs that this request cannot make, before anything is computed.
void check_outputs(const Invocation& invocation) {
  if (invocation.wants("regions-out") && invocation.parameters.flag("full")) {
    throw UsageError("--regions-out: there are no regions with --full");
  }
  const bool decomposes =
      !invocation.parameters.flag("full") && !invocation.find<RegionData>("regions");
  if (invocation.wants("components-out") && !decomposes) {
    throw UsageError("--components-out: there are no components with --full or --regions");
  }
  if (!invocation.wants("weights-out")) return;
  for (const NamedData& target : invocation.inputs.at("target")) {
    if (solves_for_vertices(invocation.parameters, std::get<BlendshapeModel>(target.data))) {
      throw UsageError("--weights-out: " + target.name + " is solved for vertices, not weights");
    }
  }
}

Outcome run_transfer(const Invocation& invocation) {
  const Stopwatch stopwatch;
  const Alignment source = prepare_source(invocation);
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  for (const NamedData& target : targets) check_target(source.sequence, target);
  check_outputs(invocation);
  Choice choice = choose(invocation, source);
  const bool give_back = !source.motion.empty() && invocation.parameters.choice<RemovedMotion>(
                                                       "head-motion") == RemovedMotion::keep;

  Outcome outcome;
  Json reports = Json::array();
  const double first = choice.regions ? 0.4 : 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const double count = static_cast<double>(targets.size());
    const Progress progress =
        part_of(invocation.progress, first + (1 - first) * static_cast<double>(t) / count,
                first + (1 - first) * static_cast<double>(t + 1) / count);
    Solution solution = solve(invocation, source, targets[t], choice.selection, progress);
    const TransferError error =
        transfer_error(source.sequence, solution.sequence, choice.selection.triangles);
    reports.push_back(report_of(targets[t], solution, error));
    const auto paths = invocation.wanted.find("out");
    if (paths != invocation.wanted.end() && !paths->second.empty()) {
      reports.back()["output"] = paths->second.at(t).string();
    }
    outcome.summary += summary_of(targets[t], solution, error);
    if (invocation.wants("weights-out") && solution.weights.size() > 0) {
      outcome.outputs["weights-out"].push_back(weight_table(targets[t], solution));
    }
    MeshSequence result = std::move(solution.sequence);
    if (give_back) {
      // The neutral has no head motion: kept beside these frames it would promise that they have
      // none.
      const MeshSequence moved = with_motion(result, source.motion);
      result = MeshSequence(moved.shared_connectivity(), moved.positions(), moved.times());
    }
    outcome.outputs["out"].push_back(
        {targets[t].name, SequenceRead{std::move(result), false, {}, {}}});
  }
  if (invocation.wants("components-out")) {
    outcome.outputs["components-out"].push_back({"", std::move(*choice.components)});
  }
  Json report = {{"targets", reports}};
  if (choice.regions) {
    Json regions = report_of(*choice.regions);
    regions["seconds"] = choice.seconds;
    report["regions"] = regions;
    outcome.summary = summary_of(*choice.regions) + outcome.summary;
    if (invocation.wants("regions-out")) {
      outcome.outputs["regions-out"].push_back(
          {"", RegionData{*choice.regions,
                          {invocation.get<SequenceRead>("source").sequence,
                           fields_of(*choice.regions), true}}});
    }
  }
  report["seconds"] = stopwatch.seconds();
  outcome.report = report.dump();
  return outcome;
}

/// Decomposition, then one target after the other, whose results are kept.
double memory_of_transfer(const Invocation& invocation) {
  const SequenceRead& source = invocation.get<SequenceRead>("source");
  const bool looks_for_regions =
      !invocation.parameters.flag("full") && !invocation.find<RegionData>("regions");
  const double analysis =
      looks_for_regions ? analysis_bytes(invocation, source, invocation.parameters.integer("k"))
                        : 0;
  double solutions = alignment_bytes(invocation, source);
  for (const NamedData& target : invocation.inputs.at("target")) {
    solutions += solution_bytes(invocation, source, std::get<BlendshapeModel>(target.data));
  }
  return std::max(analysis, solutions);
}

}  // namespace

Operation transfer_operation() {
  Operation operation;
  operation.name = "transfer";
  operation.summary = "Transfer a sequence's deformation to other characters, by regions";
  operation.inputs = {
      {"source", DataKind::sequence, "sequence whose deformation is transferred"},
      {"target", DataKind::model, "model (MODEL or MODEL@identity=1.5) or mesh that receives it",
       false, true},
      {"components", DataKind::components, "components (.h5) of an earlier decompose", true},
      {"regions", DataKind::regions, "region set: .json, .csv, .txt, or .vtp with the field roi",
       true}};
  operation.outputs = {
      {"out", DataKind::sequence,
       "a folder of frames, .npy, or a mesh file; with several targets a folder with one each",
       false, true},
      {"regions-out", DataKind::regions, "regions: .pvd (a time series), .vtp, .json or .csv",
       true},
      components_output(),
      {"weights-out", DataKind::table, "blendshape weights: .csv or .json", true, true}};
  operation.parameters = {
      {"full", ParameterKind::flag, false, "use all triangles instead of regions"},
      choice_parameter("head-motion", RemovedMotion::keep,
                       "give the motion that --align took out back to the target, or drop it")};
  for (const auto& group : {region_parameters(), decomposition_parameters(30),
                            alignment_parameters(), solving_parameters()}) {
    for (const Parameter& parameter : group) operation.parameters.push_back(parameter);
  }
  operation.examples = {
      "transfer takes/smile_%04d.obj actor/ -k 30 -o actor_smile/ --regions-out rois/smile.pvd",
      "transfer take.npy actor@identity007=2 double/ --full -o results/"};
  operation.run = run_transfer;
  operation.memory = memory_of_transfer;
  return operation;
}

}  // namespace mimetra
