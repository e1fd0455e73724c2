#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/example_folder.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_names.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/rig.h"

namespace mimetra {

namespace {

struct RigCall {
  /// Folder of examples.
  std::optional<std::filesystem::path> examples = {};
  bool estimate_weights = false;
  RigOptions rig = {};

  static constexpr Option kExamples{"examples", &RigCall::examples};
  static constexpr Option kEstimateWeights{"estimate_weights", &RigCall::estimate_weights};
};

BoundParameters<ExampleRigOptions> example_fit_parameters() {
  using Options = ExampleRigOptions;
  BoundParameters<Options> list;
  return list
      .add("share", Options::kShare,
           "how much expressions that move a triangle alike share of what examples tell; 0: true "
           "shapes tell nothing of other expressions")
      .add("prior", Options::kPrior, "pull towards the transferred expressions, against poses")
      .add("kappa", Options::kKappa,
           "the pull is ((1 + m) / (kappa + m))^theta times that where an expression moves by m")
      .add("theta", Options::kTheta, "exponent of that")
      .add("rounds", Options::kRounds, "of --estimate-weights at most");
}

BoundParameters<RigCall> rig_parameters() {
  BoundParameters<RigOptions> rig;
  rig.add(&RigOptions::examples, example_fit_parameters())
      .add(axes_parameters<RigOptions>())
      .add(triangle_weight_parameters<RigOptions>());
  BoundParameters<RigCall> list;
  return list
      .add("examples", RigCall::kExamples,
           "folder of meshes of the target: true shapes, named as expressions of the source, and "
           "poses, whose weights an examples.csv there has (mesh,jawOpen,...)")
      .add("estimate-weights", RigCall::kEstimateWeights,
           "meshes that no expression and no row of examples.csv names are poses, whose weights "
           "are looked for")
      .add(&RigCall::rig, rig);
}

std::string guess(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "there are " + listed(known, 60) : "did you mean '" + nearest + "'?";
}

/// Returns an example's weights by expression, from its row of examples.csv.
Eigen::VectorXd given_weights(const ExampleFolder& folder, Eigen::Index row,
                              const std::vector<std::string>& expressions,
                              const std::string& path) {
  const WeightMatch match = match_weights(folder.weights, expressions);
  if (!match.unmatched_columns.empty()) {
    const std::string& column = match.unmatched_columns.front();
    throw MismatchError(path + "/examples.csv: '" + column + "' is no expression of the source; " +
                        guess(column, expressions));
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(expressions.size()));
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    if (match.column[j] < 0) continue;
    const double weight = folder.weights.weights(row, match.column[j]);
    if (weight < 0 || weight > 1) {
      throw MismatchError(path + "/examples.csv: the weight of '" + expressions[j] + "' is " +
                          readable(weight) + " for mesh '" +
                          folder.weighted[static_cast<std::size_t>(row)] + "', expected 0 to 1");
    }
    weights[static_cast<Eigen::Index>(j)] = weight;
  }
  return weights;
}

/// Returns the meaning of an example. Throws MismatchError if its name and its row give none.
ExampleMeaning meaning_of(const ExampleShape& shape, const ExampleFolder& folder,
                          const ShapeBasis& expressions, const RigCall& call) {
  const auto weighted = std::ranges::find(folder.weighted, shape.name);
  if (weighted != folder.weighted.end()) {
    return given_weights(folder, weighted - folder.weighted.begin(), expressions.names,
                         call.examples->string());
  }
  const int expression = expression_named(shape.name, expressions.names);
  if (expression >= 0) return expression;
  if (call.estimate_weights) return {};
  throw MismatchError(shape.path.string() + ": '" + shape.name +
                      "' is no expression of the source; " + guess(shape.name, expressions.names) +
                      " (a pose needs a row in examples.csv, or --estimate-weights)");
}

std::vector<RigExample> examples_of(const Invocation& invocation, const RigCall& call) {
  if (!call.examples) return {};
  const NamedData& target = invocation.input("target");
  const ShapeBasis& expressions = person_of(invocation.input("source")).expressions();
  ExampleFolder folder =
      read_examples(*call.examples, person_of(target).connectivity(), target.name);
  std::vector<RigExample> examples;
  for (ExampleShape& shape : folder.shapes) {
    if (shape.name == "neutral" && expressions.find(shape.name) < 0) {
      invocation.warn(shape.path.string() + ": is left out; the neutral is the target's");
      continue;
    }
    ExampleMeaning meaning = meaning_of(shape, folder, expressions, call);
    examples.push_back({shape.name, std::move(shape.pose), std::move(meaning)});
  }
  check_sizes(examples, person_of(target).neutral(), target.name);
  return examples;
}

constexpr const char* kNoExamples = "there are no examples without --examples";

std::vector<Exclusion> rig_exclusions() {
  return concatenated<Exclusion>(
      {{{{"estimate-weights", "rounds", "prior"}, {"!examples"}, kNoExamples},
        {{"rounds"},
         {"!estimate-weights"},
         "no weights are looked for without --estimate-weights"}},
       pairing_exclusions()});
}

/// Refuses options about examples if neither a folder nor the target's own expressions give any.
void check_rig_options(const Invocation& invocation, const RigCall& call) {
  if (call.examples || person_of(invocation.input("target")).expressions().size() > 0) return;
  for (const std::string name : {"kappa", "theta", "share"}) {
    if (invocation.parameters.is_set(name)) throw UsageError("--" + name + ": " + kNoExamples);
  }
}

Json json_of(const Rig& made, const std::vector<RigExample>& examples) {
  Json expressions = Json::array(), of_examples = Json::array();
  for (const RiggedExpression& each : made.expressions) {
    expressions.push_back({{"name", each.name},
                           {"origin", choice_name(each.origin)},
                           {"largest_displacement", each.largest},
                           {"changed_by_examples", each.change},
                           {"flipped", each.flipped}});
  }
  for (std::size_t s = 0; s < made.examples.size(); ++s) {
    Json weights = Json::object();
    for (Eigen::Index j = 0; j < made.weights.cols(); ++j) {
      const double weight = made.weights(static_cast<Eigen::Index>(s), j);
      if (weight > 0) weights[made.expressions[static_cast<std::size_t>(j)].name] = weight;
    }
    const bool is_estimated =
        s < examples.size() && std::holds_alternative<std::monostate>(examples[s].meaning);
    of_examples.push_back(
        {{"name", made.examples[s]}, {"estimated", is_estimated}, {"weights", weights}});
  }
  Json report{{"expressions", expressions},
              {"examples", of_examples},
              {"missed", made.missed},
              {"axes",
               {{"angle", made.similarity.angle()},
                {"scale", made.similarity.scale},
                {"mirrored", made.similarity.mirrors()}}}};
  if (made.match) report["correspondence"] = json_of(*made.match);
  return report;
}

std::string summary_of(const Rig& made, const std::string& target) {
  const auto count = [&made](RigOrigin origin) {
    return std::ranges::count(made.expressions, origin, &RiggedExpression::origin);
  };
  int flipped = 0;
  for (const RiggedExpression& each : made.expressions) flipped += each.flipped;
  std::vector<std::string> parts;
  for (const RigOrigin origin :
       {RigOrigin::transferred, RigOrigin::corrected, RigOrigin::example, RigOrigin::own}) {
    if (const auto of_origin = count(origin); of_origin > 0) {
      parts.push_back(std::to_string(of_origin) + ' ' + std::string(choice_name(origin)));
    }
  }
  return target + ": " + std::to_string(made.expressions.size()) + " expressions, " +
         joined(parts) + "; " + std::to_string(flipped) + " flipped triangles" +
         (made.match ? "; " + summary_of(*made.match) : "") + '\n';
}

RigCall read_rig_call(const Invocation& invocation) {
  RigCall call = rig_parameters().read(invocation.parameters);
  check_rig_options(invocation, call);
  const NamedData& source = invocation.input("source");
  if (person_of(source).expressions().size() == 0) {
    throw MismatchError(source.name + ": the source has no expressions");
  }
  return call;
}

void foresee_rig(const Invocation& invocation) {
  const RigCall call = read_rig_call(invocation);
  examples_of(invocation, call);
  check_targets(invocation, targets_of(invocation),
                *frame_of_each_expression(person_of(invocation.input("source"))), {});
}

Outcome run_rig(const Invocation& invocation) {
  const Stopwatch stopwatch;
  const RigCall call = read_rig_call(invocation);
  const NamedData& target = invocation.input("target");
  const std::vector<RigExample> examples = examples_of(invocation, call);
  Rig made = in_command_terms(invocation.parameters, [&] {
    return rig(person_of(invocation.input("source")), targets_of(invocation).front(), examples,
               call.rig, invocation.context);
  });
  Outcome outcome;
  Json report = json_of(made, examples);
  report["seconds"] = stopwatch.seconds();
  outcome.report = json_text(report);
  outcome.summary = summary_of(made, target.name);
  NamedData out;
  if (made.pairing) {
    out.beside[".correspondence.json"] = correspondence_json(
        made.pairing->triangles(), person_of(invocation.input("source")).connectivity(),
        made.model.connectivity());
  }
  out.data = ModelData{MorphableModel(std::move(made.model)), {}, {}};
  outcome.outputs["out"].push_back(std::move(out));
  return outcome;
}

double memory_of_rig(const Invocation& invocation) {
  return rig_bytes(person_of(invocation.input("source")), person_of(invocation.input("target")));
}

}  // namespace

Operation rig_operation() {
  Operation operation;
  operation.name = "rig";
  operation.summary = "Make the full set of a model's expressions for another character";
  operation.inputs = {
      {"source", DataKind::model, "model that has the expressions"},
      {"target", DataKind::model, "mesh, or model that has some of them, which it keeps"}};
  operation.outputs = {{"out", DataKind::model, "the target with all expressions"}};
  operation.outputs.front().paired = true;
  operation.parameters =
      concatenated<Parameter>({rig_parameters().declared(), pairing_parameters()});
  operation.exclusions = rig_exclusions();
  operation.examples = {"rig actor/ double.ply -o double/",
                        "rig actor/ double.ply --examples double_scans/ -o double.glb"};
  operation.run = run_rig;
  operation.foresee = foresee_rig;
  operation.memory = memory_of_rig;
  return operation;
}

}  // namespace mimetra
