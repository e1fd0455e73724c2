#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/paint_parameter.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/operations/weight_tables.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

const BoundParameters<TransferOptions>& transfer_parameters() {
  using Options = TransferOptions;
  static const auto list =
      BoundParameters<Options>()
          .add("full", Options::kFull,
               "use all triangles instead of regions; the default for meshes without expressions "
               "if no option asks for regions")
          .brief("use all triangles instead of regions")
          .add("head-motion", Options::kHeadMotion,
               "give the motion that --align took out back to the target, or drop it")
          .brief("motion that --align took")
          .add(&Options::regions, region_parameters())
          .add(&Options::regions, completion_parameters())
          .add(&Options::analysis, count_parameters())
          .add(&Options::analysis, analysis_rest_parameters())
          .add(&Options::analysis, analysis_parameters())
          .add(&Options::source, alignment_parameters())
          .add(&Options::source, source_rest_parameters())
          .add(&Options::solve, solving_parameters());
  return list;
}

const std::vector<Exclusion>& transfer_exclusions() {
  static const std::string no_choice = "no regions are looked for with --full or --regions";
  static const auto list = concatenated<Exclusion>(
      {paint_exclusions(),
       solving_exclusions(),
       {{{"regions"}, {"full"}, "--full takes all triangles; leave one of them out"},
        {{"falloff", "per-region", "regions-out"}, {"full"}, "there are no regions with --full"},
        {concatenated<std::string>({{"only", "without", "select", "triangles", "drop-rims",
                                     "region", "coverage", "k", "components"},
                                    options_of_decomposition()}),
         {"full", "regions"},
         no_choice},
        {{"radius", "complete", "complete-limit"}, {"full"}, no_choice},
        {{"components-out"},
         {"full", "regions"},
         "there are no components with --full or --regions"}},
       selection_exclusions(),
       pairing_exclusions()});
  return list;
}

/// True if an option, input or output of the call is refused beside --full.
bool asks_for_regions(const Invocation& invocation) {
  Parameters with_full = invocation.parameters;
  with_full.set("full", true);
  return refusal(transfer_exclusions(), with_full,
                 [&invocation](const std::string& name) {
                   return invocation.has_input(name) || invocation.wants(name);
                 })
      .has_value();
}

/// True if the call requests all triangles, or by default. Without expressions, vertices outside
/// the regions would stay behind.
bool takes_all_triangles(const Invocation& invocation) {
  if (invocation.parameters.flag("full")) return true;
  const auto has_expressions = [](const NamedData& target) {
    return person_of(target).expressions().size() > 0;
  };
  return std::ranges::none_of(invocation.inputs.at("target"), has_expressions) &&
         !asks_for_regions(invocation);
}

TransferOptions options_of(const Invocation& invocation) {
  const NamedData& source = invocation.input("source");
  TransferOptions options =
      transfer_parameters().read(invocation.parameters, &std::get<FieldSequence>(source.data));
  options.full = takes_all_triangles(invocation);
  if (!options.full) set_usual_border(invocation, options.solve);
  options.source = described(std::move(options.source), source);
  options.regions = with_most_discs(options.regions, invocation.parameters);
  if (auto painted = painted_region_of(invocation)) {
    options.given = std::move(*painted);
  } else if (const RegionData* regions = invocation.find<RegionData>("regions")) {
    options.given = GivenRegions{invocation.input("regions").name, regions->regions};
  } else if (auto components = given_components(invocation)) {
    options.given = std::move(*components);
  }
  return options;
}

NamedData weights_of(const NamedData& target, const Solution& solution) {
  return {target.name, weight_table(WeightTrack{solution.weight_names(), solution.weights(),
                                                solution.sequence->times()})};
}

/// `has_own_regions` if the report's common regions are not this target's.
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
    json["weight"] = weights_report(weights, parameters, options.solve.falloff);
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

/// False if the call gives regions, or takes all triangles.
bool looks_for_regions(const Invocation& invocation) {
  return !takes_all_triangles(invocation) && !invocation.find<RegionData>("regions") &&
         !invocation.parameters.optional_text("paint");
}

/// Refuses options that would change regions with vertex weights.
void check_given_weights(const Invocation& invocation) {
  const auto* given = invocation.find<RegionData>("regions");
  if (!given || given->regions.weights.size() == 0) return;
  const std::string& name = invocation.input("regions").name;
  if (invocation.parameters.flag("per-region")) {
    throw UsageError("--per-region: " + name +
                     " holds weights of vertices, which say how much of the motion each takes; "
                     "weights of each region move the whole face");
  }
  for (const std::string option : {"complete", "complete-limit"}) {
    if (!invocation.parameters.is_set(option)) continue;
    throw UsageError("--" + option + ": " + name +
                     " holds weights of vertices and is taken as it is");
  }
}

/// Refuses outputs that this request cannot make, before anything is computed.
void check_outputs(const Invocation& invocation, const TransferOptions& options) {
  check_given_weights(invocation);
  check_solving(invocation);
  check_given_components(invocation);
  if (looks_for_regions(invocation) && has_own_regions(options.regions) &&
      invocation.wants("regions-out") && invocation.inputs.at("target").size() > 1) {
    const std::string reason = options.regions.select == Selector::transfer
                                   ? "with --select transfer each target has"
                                   : "with --triangles discs of --complete take the place of "
                                     "others, so that each target has";
    throw UsageError("--regions-out: " + reason +
                     " regions of its own; name one target, or take the regions of one for all "
                     "(--regions)");
  }
  if (!invocation.wants("weights-out")) return;
  for (const NamedData& target : invocation.inputs.at("target")) {
    if (solves_for_vertices(person_of(target), options.solve.space)) {
      throw UsageError("--weights-out: " + target.name + " is solved for vertices, not weights");
    }
    if (options.solve.per_region) check_no_live_link(invocation, "weights-out");
    check_live_link(invocation, "weights-out", person_of(target).expressions().names);
  }
}

/// Returns the call's options. Throws and warns before anything is computed.
TransferOptions checked_options(const Invocation& invocation) {
  const NamedData& source = invocation.input("source");
  warn_of_guessed_rate(invocation, source.name,
                       std::get<FieldSequence>(source.data).frames->times_are_known());
  TransferOptions options = options_of(invocation);
  check_outputs(invocation, options);
  return options;
}

void foresee_transfer(const Invocation& invocation) {
  const FrameSource& source = *invocation.get<FieldSequence>("source").frames;
  const TransferOptions options = checked_options(invocation);
  const auto* regions = std::get_if<GivenRegions>(&options.given);
  if (regions) check_regions(*regions, source);
  check_border(invocation, regions, options.solve);
  if (const auto* components = std::get_if<GivenComponents>(&options.given)) {
    check_components(*components, source);
  }
  check_targets(invocation, targets_of(invocation), source, options.solve);
}

/// Adds the results of each target, in the order of the targets.
void add_targets(Outcome& outcome, Json& report, const Invocation& invocation,
                 const TransferOptions& options, TransferResult& result) {
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  const auto paths = invocation.wanted.find("out");
  const bool is_written = paths != invocation.wanted.end() && !paths->second.empty();
  const Context at_end = invocation.context.part(1, 1).without_ranks();
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
    FieldSequence made = held_like(source, std::move(solution.sequence), at_end);
    std::vector<NamedData>& all = outcome.outputs["out"];
    all.push_back({targets[t].name, FieldSequence()});
    NamedData& out = all.back();
    // Hosts that take values show these fields. Formats with fields write them.
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
  const FrameSource& source = *invocation.get<FieldSequence>("source").frames;
  const TransferOptions options = checked_options(invocation);
  TransferResult result = in_command_terms(invocation.parameters, [&] {
    return transfer(source, targets_of(invocation), options, within_memory(invocation));
  });
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

/// Number of regions, or its upper limit.
int region_count(const Invocation& invocation, const TransferOptions& options) {
  if (const RegionData* given = invocation.find<RegionData>("regions")) {
    return static_cast<int>(given->regions.regions.size());
  }
  if (const Components* components = invocation.find<Components>("components")) {
    return components->count();
  }
  return options.analysis.count;
}

/// The plan of the decomposition; empty if the run does not decompose the source to find regions.
DecompositionPlan plan_of_transfer(const Invocation& invocation, const TransferOptions& options) {
  if (!looks_for_regions(invocation) || options.regions.select == Selector::transfer) return {};
  return analysis_plan(invocation, *invocation.get<FieldSequence>("source").frames,
                       options.analysis);
}

/// Peak of the decomposition, and of one target after the other. All targets' results stay in
/// memory.
double memory_of_transfer(const Invocation& invocation) {
  const FieldSequence& held = invocation.get<FieldSequence>("source");
  const TransferOptions options = transfer_parameters().read(invocation.parameters);
  const FrameSource& frames = *held.frames;
  double solutions = stored_bytes(frames), most_selection = 0;
  for (const NamedData& target : invocation.inputs.at("target")) {
    solutions += solution_bytes(frames, person_of(target), options.solve, invocation.context);
    if (options.regions.select == Selector::transfer) {
      most_selection = std::max(most_selection, selection_bytes(frames, person_of(target)));
    }
    if (options.solve.per_region) {
      solutions += regional_bytes(frames, person_of(target), region_count(invocation, options),
                                  invocation.context);
    }
    // If the source is in memory, so are the results.
    if (held.is_in_memory()) solutions += frame_bytes(frames);
  }
  return std::max(plan_of_transfer(invocation, options).bytes, solutions + most_selection);
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
  operation.parameters = concatenated<Parameter>(
      {transfer_parameters().declared(), {paint_parameter()}, match_parameters()});
  operation.exclusions = transfer_exclusions();
  operation.examples = {
      "transfer takes/smile_%04d.obj actor/ -k 30 -o actor_smile/ --regions-out rois/smile.pvd",
      "transfer take.npy actor@identity007=2 double/ --full -o results/"};
  operation.measures = transfer_measures();
  operation.run = run_transfer;
  operation.shared = true;
  operation.memory = memory_of_transfer;
  operation.scratch = [](const Invocation& invocation) {
    const TransferOptions options = transfer_parameters().read(invocation.parameters);
    return plan_of_transfer(invocation, options).scratch_bytes;
  };
  operation.foresee = foresee_transfer;
  return operation;
}

}  // namespace mimetra
