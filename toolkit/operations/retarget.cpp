#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/retargeting_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/operations/weight_tables.h"
#include "toolkit/pipeline/retarget.h"
#include "toolkit/transfer/linear_transfer.h"

namespace mimetra {

namespace {

/// Options of a map's weights and of meshes' weights, and --axes for meshes.
BoundParameters<RetargetOptions> retarget_parameters() {
  auto list = axes_parameters<RetargetOptions>();
  return list.add("smoothness", RetargetOptions::kSmoothness, "time constant of smooth weights")
      .add(blendshape_parameters<RetargetOptions>());
}

/// Result of a call, by meshes or by a map.
struct Retargeted {
  std::vector<std::string> source_names = {}, target_names = {};
  Eigen::MatrixXd driving = {};  ///< weights of the source (F x D_s)
  Eigen::MatrixXd weights = {};  ///< weights of the target (F x D_t)
  std::optional<Retargeting> map = {};
  /// Contents of a file, if the rigs' faces differ.
  std::optional<std::string> correspondence = {};
  bool by_map = false;
  Json report = Json::object();
  std::string summary = {};
};

std::vector<Exclusion> retarget_exclusions() {
  return concatenated<Exclusion>(
      {{{{"map"},
         {"source", "target"},
         "it stands for SOURCE and TARGET; leave one or the other out"},
        {{"map-out"}, {"map"}, "a map is kept of meshes, and --map reads none"},
        {{"axes", "markers", "index-base", "ignore-files", "correspondence"},
         {"map"},
         "it is about meshes, and --map reads none"},
        {{"symmetry", "exclusive", "rules"},
         {"map"},
         "weights by --map are bounded, and have no other rules"}},
       pairing_exclusions()});
}

/// --frames, --fps and --weight-scale.
std::vector<Parameter> driving_parameters() {
  return reading_parameters({"frames", "fps", "weight-scale"});
}

/// Returns the weights that drive `expressions`, and their times, in the selected frames.
WeightTrack chosen_track(const Invocation& invocation,
                         const std::vector<std::string>& expressions) {
  const ReadOptions options = read_options(driving_parameters(), invocation.parameters);
  const NamedData& weights = invocation.input("weights");
  WeightTrack track = track_of(std::get<Table>(weights.data));
  const std::string name = weights.name.empty() ? "weights" : weights.name;
  scale_weights(name, track, expressions, options.weight_scale);
  note_odd_times(track);
  for (const std::string& note : track.notes) {
    const std::string text = name + ": " + note;
    // Reading has reported these notes already.
    const std::vector<std::string>& said = weights.origin.notes;
    if (std::ranges::find(said, text) == said.end()) invocation.warn(text);
  }
  const auto frames = static_cast<int>(track.weights.rows());
  if (track.times.size() > 0) {
    check_rate(weights.name, track.times, options.fps);
  } else if (options.fps) {
    track.times = Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / *options.fps;
  }
  const std::vector<int> chosen = selected_frames(options.frames, frames);
  track.weights = Eigen::MatrixXd(track.weights(chosen, Eigen::all));
  if (track.times.size() > 0) track.times = Eigen::VectorXd(track.times(chosen));
  return track;
}

/// Sets the source's weights. Reports the columns of the track and the expressions without a match.
void drive_source(const Invocation& invocation, const WeightTrack& track, Retargeted& made) {
  const std::string& name = invocation.input("weights").name;
  try {
    made.driving = weights_for(track, made.source_names);
  } catch (const MismatchError& error) {
    throw MismatchError(name + ": " + error.what());
  }
  const WeightMatch match = match_weights(track, made.source_names);
  if (!match.unmatched_columns.empty()) {
    invocation.warn(name + ": columns that drive no expression of the source: " +
                    listed(match.unmatched_columns));
  }
  if (!match.undriven_expressions.empty()) {
    invocation.warn(name + ": expressions of the source that no column drives: " +
                    listed(match.undriven_expressions));
  }
  Json matched = Json::array();
  for (std::size_t j = 0; j < match.column.size(); ++j) {
    if (match.column[j] >= 0) matched.push_back(made.source_names[j]);
  }
  made.report["matched"] = std::move(matched);
  made.report["unmatched"] = match.unmatched_columns;
  made.report["undriven"] = match.undriven_expressions;
}

/// Inputs and options of a call.
struct RetargetCall {
  RetargetOptions options;
  BlendshapeTransferOptions of_map;
  /// Replaces two models.
  std::optional<Retargeting> map;
  WeightTrack track;
};

/// Reads a call by a map, without solving it.
Retargeted read_map(const Invocation& invocation, const RetargetCall& call) {
  Retargeted made;
  made.by_map = true;
  made.map = call.map;
  try {
    check_map(*made.map, call.of_map);
  } catch (const MismatchError& error) {
    throw MismatchError(invocation.input("map").name + ": " + error.what());
  }
  made.source_names = made.map->source_names;
  made.target_names = made.map->target_names;
  check_live_link(invocation, "out", made.target_names);
  drive_source(invocation, call.track, made);
  return made;
}

/// Returns the weights of a kept map.
Eigen::MatrixXd weights_by_map(const Retargeted& made, const RetargetCall& call,
                               const Context& context) {
  const Eigen::VectorXd& times = call.track.times;
  return retargeted(
      *made.map, made.driving,
      times.size() > 0 ? times : default_times(static_cast<int>(call.track.weights.rows())),
      call.of_map, context);
}

Retargeted by_map(const Invocation& invocation, const RetargetCall& call) {
  Retargeted made = read_map(invocation, call);
  made.weights = weights_by_map(made, call, invocation.context.part(0, 0));
  return made;
}

void add_transfer(const TransferredTarget& transferred, Retargeted& made) {
  made.report["missed"] = missed_share(transferred.error);
  made.report["condition"] = transferred.solution.conditions.condition;
  made.report["unseen"] = transferred.solution.conditions.unseen;
  if (transferred.match) made.report["correspondence"] = json_of(*transferred.match);
  if (!transferred.openings.empty()) made.report["openings"] = json_of(transferred.openings);
  made.summary += percent(missed_share(transferred.error)) + " of the deformation is missing" +
                  (transferred.match ? "; " + summary_of(*transferred.match) : "") + '\n' +
                  summary_of(transferred.openings);
}

/// A call by meshes, before it is solved.
struct Driven {
  std::shared_ptr<const Animation> animation;
  /// Has `animation` as its source.
  Invocation invocation;
  Retargeted made = {};
};

Driven driven_source(const Invocation& invocation, const WeightTrack& track) {
  const auto model =
      std::make_shared<const BlendshapeModel>(invocation.get<ModelData>("source").model.average());
  const NamedData& source = invocation.input("source");
  Retargeted made;
  made.source_names = model->expressions().names;
  if (made.source_names.empty()) {
    throw MismatchError(source.name + ": has no expressions that weights could drive");
  }
  drive_source(invocation, track, made);
  const auto animation = std::make_shared<const Animation>(model, made.driving, track.times);
  Invocation driven = invocation;
  driven.inputs["source"] = {NamedData{source.name, FieldSequence(animation), source.origin}};
  return {animation, std::move(driven), std::move(made)};
}

/// Refuses outputs that cannot be made for this target.
void check_wanted(const Invocation& invocation, const Target& target) {
  for (const std::string kept : {"map-out", "matrix-out"}) {
    if (target.rules.empty() || !invocation.wants(kept)) continue;
    throw MismatchError("--" + kept + ": a map and a matrix keep no rules of expressions, and " +
                        target.rules.name + " has some; leave them out by --rules none");
  }
  check_live_link(invocation, "out", target.model.get().expressions().names);
}

Retargeted by_meshes(const Invocation& invocation, const RetargetCall& call) {
  Driven driven = driven_source(invocation, call.track);
  const Target target = targets_of(driven.invocation).front();
  check_wanted(invocation, target);
  Retargeted made = std::move(driven.made);
  made.target_names = target.model.get().expressions().names;
  RetargetOptions options = call.options;
  options.source_name = invocation.input("source").name;
  options.keep_map = invocation.wants("map-out") || invocation.wants("matrix-out");
  RetargetResult result = retarget(*driven.animation, target, options, invocation.context);
  made.weights = result.transferred.solution.weights();
  made.map = std::move(result.map);
  if (const auto& pairing = result.transferred.pairing) {
    made.correspondence = correspondence_json(
        pairing->triangles(), driven.animation->connectivity(), target.model.get().connectivity());
  }
  add_transfer(result.transferred, made);
  return made;
}

Json json_of(const WeightDifference& difference) {
  return {{"rms", difference.rms}, {"mean", difference.mean}, {"largest", difference.largest}};
}

std::string summary_of(const WeightDifference& difference) {
  return readable(difference.rms, 2) + " rms, " + readable(difference.mean, 2) + " on average, " +
         readable(difference.largest, 2) + " at most";
}

/// Columns of the target's and the source's weights with a common name.
struct SharedNames {
  std::vector<Eigen::Index> target = {}, source = {};

  explicit SharedNames(const Retargeted& made) {
    WeightTrack driving;
    driving.names = made.source_names;
    const std::vector<int> column = match_weights(driving, made.target_names).column;
    for (std::size_t j = 0; j < column.size(); ++j) {
      if (column[j] < 0) continue;
      source.push_back(column[j]);
      target.push_back(static_cast<Eigen::Index>(j));
    }
  }

  WeightDifference difference(const Eigen::MatrixXd& weights, const Retargeted& made) const {
    return difference_of(weights(Eigen::all, target), made.driving(Eigen::all, source));
  }
};

/// Reports expressions of the target that nothing moves. Also reports how far weights with a common
/// name differ from the source's.
void add_weights(const Invocation& invocation, Retargeted& made) {
  std::vector<std::string> still;
  for (Eigen::Index j = 0; j < made.weights.cols(); ++j) {
    if (made.weights.col(j).isZero(0)) {
      still.push_back(made.target_names[static_cast<std::size_t>(j)]);
    }
  }
  if (!still.empty()) {
    invocation.warn("expressions of the target that stay 0 in all frames: " + listed(still));
  }
  made.report["still"] = still;
  const SharedNames shared(made);
  made.report["shared"] = {{"names", shared.target.size()}};
  if (shared.target.empty()) return;
  const WeightDifference difference = shared.difference(made.weights, made);
  made.report["shared"].update(json_of(difference));
  made.summary += std::to_string(shared.target.size()) +
                  " weights that have the source's names differ from its by " +
                  summary_of(difference) + '\n';
}

/// Reports how far the kept map's weights differ from the weights by meshes.
void add_map(const Invocation& invocation, const RetargetCall& call, Retargeted& made) {
  if (made.by_map || !invocation.wants("map-out")) return;
  const WeightDifference difference =
      difference_of(weights_by_map(made, call, invocation.context.part(1, 1)), made.weights);
  made.report["map"] = json_of(difference);
  made.summary += "the map's weights differ from these by " + summary_of(difference) + '\n';
}

/// Reports how far a plain matrix's weights differ, both unbounded and clipped.
void add_matrix(const Invocation& invocation, const Eigen::MatrixXd& matrix, Retargeted& made) {
  const Eigen::MatrixXd unbounded = multiplied(matrix, made.driving);
  const WeightDifference of_clipped = difference_of(clipped(unbounded, *made.map), made.weights);
  const WeightDifference of_unbounded = difference_of(unbounded, made.weights);
  made.report["matrix"] = {{"clipped", json_of(of_clipped)}, {"unbounded", json_of(of_unbounded)}};
  const SharedNames shared(made);
  if (!shared.target.empty()) {
    made.report["matrix"]["shared"] = json_of(shared.difference(unbounded, made));
  }
  invocation.warn("the matrix knows no bounds: its weights differ from these by " +
                  summary_of(of_unbounded) + ", clipped to the bounds by " +
                  summary_of(of_clipped));
}

/// Returns the options of these that are set.
std::vector<std::string> set_of(const Parameters& parameters,
                                const std::vector<std::string>& names) {
  std::vector<std::string> options;
  for (const std::string& name : names) {
    if (parameters.is_set(name)) options.push_back("--" + name);
  }
  return options;
}

/// Warns about options that a map or a matrix does not keep.
void note_options(const Invocation& invocation) {
  const std::vector<std::string> again =
      set_of(invocation.parameters, {"ridge", "l1", "smoothness"});
  const std::vector<std::string> lost = set_of(invocation.parameters, {"symmetry", "exclusive"});
  const bool keeps_map = invocation.wants("map-out");
  if (keeps_map && !again.empty()) {
    invocation.warn("--map-out: the map does not keep " + joined(again, ", ", " and ") +
                    "; give them with --map too");
  }
  if (keeps_map && !lost.empty()) {
    invocation.warn("--map-out: the map does not keep " + joined(lost, ", ", " and ") +
                    ", and --map has no such options");
  }
  std::vector<std::string> all = again;
  all.insert(all.end(), lost.begin(), lost.end());
  if (invocation.wants("matrix-out") && !all.empty()) {
    invocation.warn("--matrix-out: the matrix does not keep " + joined(all, ", ", " and "));
  }
}

RetargetCall read_call(const Invocation& invocation) {
  const bool has_models = invocation.has_input("source") && invocation.has_input("target");
  if (!has_models && !invocation.has_input("map")) {
    throw UsageError(
        "retarget: expected two models, SOURCE and TARGET, or what an earlier run kept of them "
        "(--map FILE)");
  }
  RetargetCall call;
  call.options = retarget_parameters().read(invocation.parameters);
  call.of_map.ridge = call.options.ridge;
  call.of_map.sparsity = call.options.sparsity;
  call.of_map.smoothness = call.options.smoothness;
  if (const auto* map = invocation.find<Document>("map")) {
    call.map = parse_retargeting(invocation.input("map").name, map->text);
  }
  call.track = chosen_track(
      invocation, call.map ? call.map->source_names
                           : invocation.get<ModelData>("source").model.expressions().names);
  warn_of_guessed_rate(invocation, invocation.input("weights").name, call.track.times.size() > 0);
  note_options(invocation);
  return call;
}

void foresee_retarget(const Invocation& invocation) {
  const RetargetCall call = read_call(invocation);
  if (call.map) {
    read_map(invocation, call);
    return;
  }
  const Driven driven = driven_source(invocation, call.track);
  const std::vector<Target> targets = targets_of(driven.invocation);
  check_wanted(invocation, targets.front());
  check_rigs(*driven.animation, targets.front(), invocation.input("source").name);
  check_targets(driven.invocation, targets, *driven.animation,
                {.symmetry = call.options.symmetry, .exclusive = call.options.exclusive});
}

Outcome run_retarget(const Invocation& invocation) {
  const Stopwatch stopwatch;
  const RetargetCall call = read_call(invocation);
  Retargeted made = in_command_terms(invocation.parameters, [&] {
    return call.map ? by_map(invocation, call) : by_meshes(invocation, call);
  });
  add_weights(invocation, made);
  add_map(invocation, call, made);
  Outcome outcome;
  NamedData out{"", weight_table(WeightTrack{made.target_names, made.weights, call.track.times})};
  if (made.correspondence) out.beside[".correspondence.json"] = std::move(*made.correspondence);
  outcome.outputs["out"].push_back(std::move(out));
  if (invocation.wants("map-out")) {
    outcome.outputs["map-out"].push_back({"", Document{retargeting_json(*made.map)}});
  }
  if (invocation.wants("matrix-out")) {
    const Eigen::MatrixXd matrix = plain_matrix(*made.map);
    add_matrix(invocation, matrix, made);
    outcome.outputs["matrix-out"].push_back({"", Document{plain_matrix_csv(*made.map, matrix)}});
  }
  made.report["frames"] = made.weights.rows();
  made.report["expressions"] = made.weights.cols();
  made.report["seconds"] = stopwatch.seconds();
  outcome.report = json_text(made.report);
  outcome.summary = counted(made.weights.rows(), "frame") + " of " +
                    counted(made.weights.cols(), "weight") + ", " + readable(stopwatch.seconds()) +
                    " s\n" + made.summary;
  return outcome;
}

Operation declared_operation() {
  Operation operation;
  operation.name = "retarget";
  operation.summary = "Make weights of one rig weights of another, through their meshes";
  operation.inputs = {
      {"source", DataKind::model, "model (MODEL@identity=1.5) that the weights are of", true},
      {"target", DataKind::model, "model whose weights are made", true},
      {.name = "weights",
       .kind = DataKind::table,
       .help = "blendshape weights of the source",
       .named = true},
      {"map", DataKind::document, "what --map-out kept of an earlier run, in place of both models",
       true}};
  operation.inputs[0].positional = operation.inputs[1].positional = true;
  operation.outputs = {{"out", DataKind::table, "blendshape weights of the target"},
                       {"map-out", DataKind::document,
                        "what can be applied to later weights without the models", true},
                       {"matrix-out", DataKind::document,
                        "a plain matrix, without bounds, for programs that take no more", true}};
  operation.outputs[0].weights = operation.outputs[0].paired = true;
  operation.outputs[1].extensions = {".json"};
  operation.outputs[2].extensions = {".csv"};
  return operation;
}

}  // namespace

Operation retarget_operation() {
  Operation operation = declared_operation();
  operation.parameters = concatenated<Parameter>(
      {retarget_parameters().declared(), match_parameters(), driving_parameters()});
  operation.exclusions = retarget_exclusions();
  operation.examples = {
      "retarget actor/ double.glb --weights talk.csv -o talk_double.csv --map-out map.json",
      "retarget --map map.json --weights take.csv -o take_double.livelink.csv"};
  operation.run = run_retarget;
  operation.foresee = foresee_retarget;
  return operation;
}

}  // namespace mimetra
