#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/paint_parameter.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

const BoundParameters<EvaluationOptions>& evaluation_parameters() {
  using Options = EvaluationOptions;
  static const auto list =
      BoundParameters<Options>()
          .add("k", Options::kCounts,
               "numbers of components, one row each; with --select transfer of discs at most")
          .add(&Options::regions, region_parameters())
          .add(&Options::regions, completion_parameters())
          .add("curve", Options::kCurve,
               "rows at a tenth to eight of the triangles instead, by energy and for the transfer; "
               "-o NAME.png draws them")
          .add(&Options::analysis, analysis_rest_parameters())
          .add(&Options::analysis, analysis_parameters())
          .add(&Options::source, alignment_parameters())
          .add(&Options::source, source_rest_parameters())
          .add(&Options::solve, solving_parameters());
  return list;
}

std::vector<Exclusion> evaluation_exclusions() {
  return concatenated<Exclusion>(
      {paint_exclusions(),
       {{{"select", "triangles", "k", "coverage"},
         {"curve"},
         "--curve has rows by energy and for the transfer, at shares of its own"},
        {{"falloff"},
         {"curve !per-region"},
         "--curve has rows at shares of the triangles, and for a transfer that moves the whole "
         "face; a border holds more, and moves the regions only"},
        {{"curve"},
         {"space=vertex"},
         "regions are chosen for a transfer by what they tell of expressions, which --space vertex "
         "does not solve for"}},
       selection_exclusions(),
       solving_exclusions(),
       pairing_exclusions()});
}

std::string text_of(const std::vector<EvaluationRow>& rows) {
  std::string text =
      "   K  vertices  triangles   share    radius       DE all   MPE all      DE in L  MPE in L  "
      "regions s"
      "  transfer s       leak    crease        by\n";
  // Separates cells by at least one space.
  const auto cell = [](const std::string& content, int width) {
    return std::string(std::max<std::size_t>(width, content.size() + 1) - content.size(), ' ') +
           content;
  };
  const auto decimals = [&cell](const std::optional<double>& value, int count, int width) {
    return cell(value ? fixed(*value, count) : "-", width);
  };
  const auto digits = [&cell](const std::optional<double>& value, int count, int width) {
    return cell(value ? readable(*value, count) : "-", width);
  };
  for (const EvaluationRow& row : rows) {
    text += row.k ? cell(std::to_string(*row.k), 4) : "full";
    text += decimals(row.vertices, 0, 10) + decimals(row.triangles, 0, 11) +
            cell(percent(row.triangle_share), 8) + digits(row.radius, 4, 10) +
            digits(row.de_all, 6, 13) + decimals(row.mpe_all, 3, 10) +
            digits(row.de_region, 6, 13) + decimals(row.mpe_region, 3, 10) +
            decimals(row.decompose_seconds, 3, 11) + decimals(row.transfer_seconds, 3, 12) +
            digits(row.leak, 4, 11) + decimals(row.crease, 2, 10) +
            cell(row.by ? std::string(choice_name(*row.by)) : "-", 10) + '\n';
  }
  return text;
}

Outcome run_evaluate(const Invocation& invocation) {
  check_solving(invocation);
  const FrameSource& sequence = *invocation.get<FieldSequence>("source").frames;
  warn_of_guessed_rate(invocation, invocation.input("source").name, sequence.times_are_known());
  EvaluationOptions options =
      evaluation_parameters().read(invocation.parameters, &invocation.get<FieldSequence>("source"));
  options.source = described(options.source, invocation.input("source"));
  if (options.regions.select == Selector::transfer && !invocation.parameters.is_set("k")) {
    options.counts = {};
  }
  set_usual_border(invocation, options.solve);
  options.given = painted_region_of(invocation);
  const std::vector<EvaluationRow> rows = in_command_terms(invocation.parameters, [&] {
    return evaluate(sequence, targets_of(invocation).front(), options, within_memory(invocation));
  });
  const Table table = table_of(rows);
  Outcome outcome;
  outcome.report = json_text(Json::parse(table.json()));
  outcome.summary = text_of(rows);
  outcome.outputs["out"].push_back({"", table});
  return outcome;
}

int most_components(const EvaluationOptions& options) {
  return options.curve ? EvaluationOptions::kCurveComponents
                       : *std::ranges::max_element(options.counts);
}

/// Plan of the largest decomposition; empty if there is none.
DecompositionPlan plan_of_evaluation(const Invocation& invocation,
                                     const EvaluationOptions& options) {
  if (options.regions.select == Selector::transfer ||
      invocation.parameters.optional_text("paint")) {
    return {};
  }
  AnalysisOptions analysis = options.analysis;
  analysis.count = most_components(options);
  return analysis_plan(invocation, *invocation.get<FieldSequence>("source").frames, analysis);
}

/// Peak of one decomposition after the other, each followed by a transfer.
double memory_of_evaluate(const Invocation& invocation) {
  const FrameSource& sequence = *invocation.get<FieldSequence>("source").frames;
  const EvaluationOptions options = evaluation_parameters().read(invocation.parameters);
  const Context& context = invocation.context;
  const BlendshapeModel& target = invocation.get<ModelData>("target").model.average();
  const bool selects = options.regions.select == Selector::transfer;
  const int most = most_components(options);
  const double selection = selects || options.curve ? selection_bytes(sequence, target) : 0;
  const double regional =
      options.solve.per_region ? regional_bytes(sequence, target, most, context) : 0;
  return std::max({plan_of_evaluation(invocation, options).bytes, selection,
                   stored_bytes(sequence) +
                       2 * solution_bytes(sequence, target, options.solve, context) + regional});
}

}  // namespace

Operation evaluate_operation() {
  Operation operation;
  operation.name = "evaluate";
  operation.summary = "The paper's Table I: error and time against the number of regions";
  operation.inputs = {
      {"source", DataKind::sequence, "sequence whose deformation is transferred"},
      {"target", DataKind::model, "model (MODEL@identity=1.5) or mesh that receives it"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::table, "the table", true}};
  operation.parameters = concatenated<Parameter>(
      {evaluation_parameters().declared(), {paint_parameter()}, match_parameters()});
  operation.exclusions = evaluation_exclusions();
  operation.examples = {"evaluate take.npy actor/ -k 10,30,40",
                        "evaluate takes/ actor@identity007=2 -k 10,20,30,40,50 -o table.csv"};
  operation.measures = evaluation_measures();
  operation.run = run_evaluate;
  operation.shared = true;
  operation.memory = memory_of_evaluate;
  operation.scratch = [](const Invocation& invocation) {
    const EvaluationOptions options = evaluation_parameters().read(invocation.parameters);
    return plan_of_evaluation(invocation, options).scratch_bytes;
  };
  operation.foresee = [](const Invocation& invocation) {
    check_solving(invocation);
    const FieldSequence& source = invocation.get<FieldSequence>("source");
    const EvaluationOptions options = evaluation_parameters().read(invocation.parameters, &source);
    const auto painted = painted_region_of(invocation);
    check_border(invocation, painted ? &*painted : nullptr, options.solve);
    check_targets(invocation, targets_of(invocation), *source.frames, options.solve);
  };
  return operation;
}

}  // namespace mimetra
