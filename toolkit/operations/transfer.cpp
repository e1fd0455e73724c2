#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/command_terms.h"
#include "toolkit/operations/convergence_report.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/measures.h"
#include "toolkit/operations/paint_parameter.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/region_report.h"
#include "toolkit/operations/selection_parameters.h"
#include "toolkit/operations/times_text.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/operations/weight_tables.h"
#include "toolkit/pipeline/memory.h"

namespace mimetra {

namespace {

BoundParameters<TransferOptions> transfer_parameters(const FieldSequence* source = nullptr) {
  using Options = TransferOptions;
  const FrameSource* sequence = source ? source->frames.get() : nullptr;
  BoundParameters<Options> list;
  return list
      .add("full", Options::kFull,
           "use all triangles instead of regions; the default for meshes without expressions if no "
           "option asks for regions")
      .brief("use all triangles instead of regions")
      .add("head-motion", Options::kHeadMotion,
           "give the motion that --align took out back to the target, or drop it")
      .brief("motion that --align took")
      .add(&Options::regions, region_parameters())
      .add(&Options::regions, completion_parameters())
      .add(&Options::analysis, count_parameters())
      .add(&Options::analysis, analysis_rest_parameters(sequence))
      .add(&Options::analysis, analysis_parameters(source))
      .add(&Options::source, alignment_parameters(sequence))
      .add(&Options::source, source_rest_parameters(sequence))
      .add(&Options::solving, solving_parameters());
}

const BlendshapeModel& model_of(const NamedData& target) {
  return std::get<ModelData>(target.data).model.average();
}

bool asks_for_regions(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  const auto is_set = [&](const std::string& name) {
    return parameters.find(name) && parameters.is_set(name);
  };
  static constexpr std::array kNames = {
      "k",         "coverage", "radius",   "only",           "without", "select",     "triangles",
      "drop-rims", "region",   "complete", "complete-limit", "falloff", "per-region", "paint"};
  return std::ranges::any_of(kNames, is_set) ||
         std::ranges::any_of(options_of_decomposition(), is_set) ||
         invocation.find<RegionData>("regions") || invocation.find<Components>("components") ||
         invocation.wants("regions-out") || invocation.wants("components-out");
}

/// All triangles, because the call says so, or by default: without expressions to solve for, what
/// lies outside the regions would stay behind.
bool takes_all_triangles(const Invocation& invocation) {
  if (invocation.parameters.flag("full")) return true;
  const auto has_expressions = [](const NamedData& target) {
    return model_of(target).expressions().size() > 0;
  };
  return std::ranges::none_of(invocation.inputs.at("target"), has_expressions) &&
         !asks_for_regions(invocation);
}

TransferOptions options_of(const Invocation& invocation) {
  const NamedData& source = invocation.input("source");
  TransferOptions options =
      transfer_parameters(&std::get<FieldSequence>(source.data)).read(invocation.parameters);
  options.full = takes_all_triangles(invocation);
  if (!options.full) set_usual_border(invocation, options.solving);
  options.source = described(std::move(options.source), source);
  options.regions = with_most_discs(std::move(options.regions), invocation.parameters);
  if (auto painted = painted_region_of(invocation)) {
    options.given = std::move(*painted);
  } else if (const RegionData* regions = invocation.find<RegionData>("regions")) {
    options.given = GivenRegions{invocation.input("regions").name, regions->regions};
  } else if (auto components = given_components(invocation)) {
    options.given = std::move(*components);
  }
  options.threads = invocation.threads;
  options.ranks = invocation.ranks;
  options.progress = invocation.progress;
  options.notes = warnings_of(invocation);
  return options;
}

NamedData weights_of(const NamedData& target, const Solution& solution) {
  return {target.name, weight_table(WeightTrack{solution.weight_names(), solution.weights(),
                                                solution.sequence->times()})};
}

/// `has_own_regions` where the source's are not those of this target.
Json report_of(const NamedData& target, const TransferredTarget& transferred, bool has_own_regions,
               const Parameters& parameters, const TransferOptions& options) {
  const auto& [solution, regions, similarity, error, pairing, match, error_seconds, openings,
               weights] = transferred;
  Json json = {{"name", target.name},          {"output", nullptr},  {"de_all", error.de_all},
               {"de_region", error.de_region}, {"leak", error.leak}, {"flipped", error.flipped},
               {"seconds", solution.seconds}};
  json["error_seconds"] = error_seconds;
  if (match) json["correspondence"] = json_of(*match);
  json["missed"] = missed_share(error);
  json["crease"] = error.crease;
  json["largest_crease"] = error.largest_crease;
  if (!openings.empty()) json["openings"] = json_of(openings);
  json["axes"] = {{"angle", similarity.angle()},
                  {"scale", similarity.scale},
                  {"mirrored", similarity.mirrors()}};
  json["collapsed_triangles"] = solution.collapsed_triangles;
  json["following_parts"] = Json::array();
  for (const FollowingPart& part : solution.following_parts) {
    json["following_parts"].push_back(
        {{"component", part.component}, {"vertices", part.vertices}, {"farthest", part.farthest}});
  }
  json["degenerate_source_triangles"] = solution.degenerate_source_triangles;
  json["degenerate_target_triangles"] = solution.degenerate_target_triangles;
  if (regions) {
    json["triangle_share"] = regions->triangle_share();
    json["added_regions"] = added_regions(*regions);
    if (has_own_regions) json["regions"] = report_of(*regions);
  }
  if (weights.size() > 0) {
    json["weight"] = weights_report(weights, parameters, options.solving.falloff);
    json["de_inside"] = error.de_inside ? Json(*error.de_inside) : Json(nullptr);
  }
  if (solution.regional) {
    json["per_region"] = {{"regions", solution.regional->shares().cols() - 1},
                          {"violation", solution.violation}};
  }
  if (solution.weights().size() > 0) {
    json["condition"] = solution.conditions.condition;
    json["unseen"] = solution.conditions.unseen;
    json["weakly_seen"] = solution.conditions.weakly_seen;
  }
  return json;
}

std::string summary_of(const NamedData& target, const TransferredTarget& transferred) {
  const auto& [solution, regions, similarity, error, pairing, match, error_seconds, openings,
               weights] = transferred;
  return target.name + ": DE " + readable(error.de_all) + " over all triangles, " +
         readable(error.de_region) + " over the regions; leak " + readable(error.leak) +
         ", crease " + readable(error.crease, 2) + " degrees, " + std::to_string(error.flipped) +
         " flipped triangles; " + readable(solution.seconds) + " s" +
         (match ? "; " + summary_of(*match) : "") + '\n' + summary_of(openings);
}

/// False if the call names regions, or takes all triangles.
bool looks_for_regions(const Invocation& invocation) {
  return !takes_all_triangles(invocation) && !invocation.find<RegionData>("regions") &&
         !invocation.parameters.optional_text("paint");
}

/// Refuses outputs that this request cannot make, before anything is computed.
void check_outputs(const Invocation& invocation) {
  TransferOptions options = transfer_parameters().read(invocation.parameters);
  options.full = takes_all_triangles(invocation);
  check_paint(invocation);
  check_solving(invocation);
  if (options.full) {
    if (invocation.find<RegionData>("regions")) {
      throw UsageError("--regions: --full takes all triangles; leave one of them out");
    }
    refuse_options(invocation.parameters, {"falloff"}, "there are no regions with --full");
    if (options.solving.per_region) {
      throw UsageError("--per-region: there are no regions with --full");
    }
  }
  if (invocation.wants("regions-out") && options.full) {
    throw UsageError("--regions-out: there are no regions with --full");
  }
  const bool chooses = looks_for_regions(invocation);
  if (!chooses) {
    const std::string reason = "no regions are looked for with --full or --regions";
    refuse_options(
        invocation.parameters,
        {"only", "without", "select", "triangles", "drop-rims", "region", "coverage", "k"}, reason);
    refuse_options(invocation.parameters, options_of_decomposition(), reason);
    if (options.full) {
      refuse_options(invocation.parameters, {"radius", "complete", "complete-limit"}, reason);
    }
    if (invocation.find<Components>("components")) throw UsageError("--components: " + reason);
  }
  check_given_components(invocation);
  check_selection(invocation);
  if (chooses && has_own_regions(options.regions) && invocation.wants("regions-out") &&
      invocation.inputs.at("target").size() > 1) {
    const std::string reason = options.regions.select == Selector::transfer
                                   ? "with --select transfer each target has"
                                   : "with --triangles discs of --complete take the place of "
                                     "others, so that each target has";
    throw UsageError("--regions-out: " + reason +
                     " regions of its own; name one target, or take the regions of one for all "
                     "(--regions)");
  }
  if (invocation.wants("components-out") && !chooses) {
    throw UsageError("--components-out: there are no components with --full or --regions");
  }
  if (!invocation.wants("weights-out")) return;
  for (const NamedData& target : invocation.inputs.at("target")) {
    if (solves_for_vertices(model_of(target), options.solving.space)) {
      throw UsageError("--weights-out: " + target.name + " is solved for vertices, not weights");
    }
    if (options.solving.per_region) check_no_live_link(invocation, "weights-out");
    check_live_link(invocation, "weights-out", model_of(target).expressions().names);
  }
}

void foresee_transfer(const Invocation& invocation) {
  check_outputs(invocation);
  const FrameSource& source = *invocation.get<FieldSequence>("source").frames;
  warn_of_guessed_rate(invocation, invocation.input("source").name, source.times_are_known());
  const TransferOptions options = options_of(invocation);
  const auto* regions = std::get_if<GivenRegions>(&options.given);
  if (regions) check_regions(*regions, source);
  check_border(invocation, regions, options.solving);
  if (const auto* components = std::get_if<GivenComponents>(&options.given)) {
    check_components(*components, source);
  }
  check_targets(invocation);
}

/// What each target's results are, in the order of the targets.
void add_targets(Outcome& outcome, Json& report, const Invocation& invocation,
                 const TransferOptions& options, TransferResult& result) {
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  const auto paths = invocation.wanted.find("out");
  const bool is_written = paths != invocation.wanted.end() && !paths->second.empty();
  Json reports = Json::array();
  for (std::size_t t = 0; t < targets.size(); ++t) {
    TransferredTarget& transferred = result.targets[t];
    const bool has_own_regions = transferred.regions && !result.regions;
    reports.push_back(
        report_of(targets[t], transferred, has_own_regions, invocation.parameters, options));
    if (is_written) reports.back()["output"] = paths->second.at(t).string();
    if (has_own_regions) outcome.summary += summary_of(*transferred.regions);
    outcome.summary += summary_of(targets[t], transferred);
    Solution& solution = transferred.solution;
    if (invocation.wants("weights-out") && solution.weights().size() > 0) {
      if (transferred.weights.size() > 0) {
        invocation.warn(targets[t].name +
                        ": its weights drive expressions that fade out where its field 'weight' "
                        "does; the whole face would move by them");
      }
      outcome.outputs["weights-out"].push_back(weights_of(targets[t], solution));
    }
    const FieldSequence& source = invocation.get<FieldSequence>("source");
    FieldSequence made =
        held_like(source, std::move(solution.sequence), {.threads = invocation.threads});
    std::vector<NamedData>& all = outcome.outputs["out"];
    all.push_back({targets[t].name, FieldSequence()});
    NamedData& out = all.back();
    // A host that takes values shows them; formats write them where they hold fields.
    std::vector<Field>& shown = is_written ? out.more_fields : made.fields;
    if (transferred.pairing) {
      const Correspondence& pairs = transferred.pairing->triangles();
      shown = fields_of(pairs);
      out.beside[".correspondence.json"] =
          correspondence_json(pairs, source.frames->connectivity(), made.frames->connectivity());
    }
    if (transferred.weights.size() > 0) {
      shown.push_back({"weight", Field::Location::vertices, transferred.weights});
    }
    out.data = std::move(made);
  }
  report["targets"] = reports;
}

void add_regions(Outcome& outcome, Json& report, const Invocation& invocation,
                 const TransferResult& result) {
  if (!result.regions) return;
  Json regions = report_of(*result.regions);
  if (result.components) add_convergence(regions, *result.components);
  regions["seconds"] = result.region_seconds;
  report["regions"] = regions;
  outcome.summary = summary_of(*result.regions) + outcome.summary;
  if (!invocation.wants("regions-out")) return;
  outcome.outputs["regions-out"].push_back(
      {"", RegionData{*result.regions, FieldSequence(invocation.get<FieldSequence>("source").frames,
                                                     fields_of(*result.regions), true)}});
}

Outcome run_transfer(const Invocation& invocation) {
  const Stopwatch stopwatch;
  check_outputs(invocation);
  const FrameSource& source = *invocation.get<FieldSequence>("source").frames;
  warn_of_guessed_rate(invocation, invocation.input("source").name, source.times_are_known());
  const TransferOptions options = options_of(invocation);
  TransferResult result = in_command_terms(
      invocation.parameters, [&] { return transfer(source, targets_of(invocation), options); });
  Outcome outcome;
  Json report = Json::object();
  add_targets(outcome, report, invocation, options, result);
  add_regions(outcome, report, invocation, result);
  if (invocation.wants("components-out")) {
    outcome.outputs["components-out"].push_back({"", std::move(*result.components)});
  }
  report["head_motion"] = json_of(result.head_motion);
  report["seconds"] = stopwatch.seconds();
  outcome.report = json_text(report);
  return outcome;
}

/// True where the run decomposes the source to find regions.
bool looks_for_components(const Invocation& invocation) {
  return looks_for_regions(invocation) && !invocation.find<Components>("components") &&
         invocation.parameters.choice<Selector>("select") == Selector::energy;
}

/// How many regions there are, or may be.
int region_count(const Invocation& invocation, const TransferOptions& options) {
  if (const RegionData* given = invocation.find<RegionData>("regions")) {
    return static_cast<int>(given->regions.regions.size());
  }
  if (const Components* components = invocation.find<Components>("components")) {
    return components->count();
  }
  return options.analysis.decomposition.count;
}

/// Of the decomposition; nothing where there is none.
DecompositionPlan plan_of_transfer(const Invocation& invocation) {
  if (!looks_for_components(invocation)) return {};
  return analysis_plan(
      invocation, *invocation.get<FieldSequence>("source").frames,
      transfer_parameters().read(invocation.parameters).analysis.decomposition.count);
}

/// Decomposition, then one target after the other, whose results are kept.
double memory_of_transfer(const Invocation& invocation) {
  const FieldSequence& held = invocation.get<FieldSequence>("source");
  TransferOptions options = transfer_parameters().read(invocation.parameters);
  options.solving.threads = invocation.threads;
  const FrameSource& frames = *held.frames;
  double solutions = stored_bytes(frames), most_selection = 0;
  for (const NamedData& target : invocation.inputs.at("target")) {
    solutions += solution_bytes(frames, model_of(target), options.solving);
    if (options.regions.select == Selector::transfer) {
      most_selection = std::max(most_selection, selection_bytes(frames, model_of(target)));
    }
    if (options.solving.per_region) {
      solutions += regional_bytes(frames, model_of(target), region_count(invocation, options),
                                  options.solving);
    }
    // Results of a source in memory are there, too.
    if (held.is_in_memory()) solutions += frame_bytes(frames);
  }
  return std::max(plan_of_transfer(invocation).bytes, solutions + most_selection);
}

}  // namespace

Operation transfer_operation() {
  Operation operation;
  operation.name = "transfer";
  operation.summary = "Transfer a sequence's deformation to other characters, by regions";
  operation.inputs = {
      {"source", DataKind::sequence, "sequence whose deformation is transferred"},
      {"target", DataKind::model, "model (MODEL@identity=1.5) or mesh that receives it", false,
       true},
      {"components", DataKind::components, "components of an earlier decompose", true},
      {"regions", DataKind::regions, "region set, in .vtp and .om the field roi", true}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {
      {"out", DataKind::sequence, "the new sequence; of several targets one each", false, true},
      {"regions-out", DataKind::regions, "the regions, as .pvd over time", true},
      components_output(),
      {"weights-out", DataKind::table, "blendshape weights", true, true}};
  operation.outputs.front().paired = true;
  operation.outputs.back().weights = true;
  operation.parameters = transfer_parameters().declared();
  operation.parameters.push_back(paint_parameter());
  const std::vector<Parameter> matching = match_parameters();
  operation.parameters.insert(operation.parameters.end(), matching.begin(), matching.end());
  operation.examples = {
      "transfer takes/smile_%04d.obj actor/ -k 30 -o actor_smile/ --regions-out rois/smile.pvd",
      "transfer take.npy actor@identity007=2 double/ --full -o results/"};
  operation.measures = transfer_measures();
  operation.run = run_transfer;
  operation.shared = true;
  operation.memory = memory_of_transfer;
  operation.scratch = [](const Invocation& invocation) {
    return plan_of_transfer(invocation).scratch_bytes;
  };
  operation.foresee = foresee_transfer;
  return operation;
}

}  // namespace mimetra
