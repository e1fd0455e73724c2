#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/operations/evaluation.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/memory.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

std::string text_of(const std::vector<EvaluationRow>& rows) {
  std::string text =
      "   K  vertices  triangles   share       DE all   MPE all      DE in L  MPE in L  regions s"
      "  transfer s\n";
  const auto cell = [](const std::optional<double>& value, const char* format, int width) {
    char buffer[32] = "-";
    if (value) std::snprintf(buffer, sizeof buffer, format, *value);
    const std::string content = buffer;
    return std::string(std::max<std::size_t>(width, content.size()) - content.size(), ' ') +
           content;
  };
  for (const EvaluationRow& row : rows) {
    text += row.k ? cell(*row.k, "%.0f", 4) : "full";
    text += cell(row.vertices, "%.0f", 10) + cell(row.triangles, "%.0f", 11) +
            cell(100 * row.triangle_share, "%.1f %%", 8) + cell(row.de_all, "%.6g", 13) +
            cell(row.mpe_all, "%.3f", 10) + cell(row.de_region, "%.6g", 13) +
            cell(row.mpe_region, "%.3f", 10) + cell(row.decompose_seconds, "%.3f", 11) +
            cell(row.transfer_seconds, "%.3f", 12) + '\n';
  }
  return text;
}

Outcome run_evaluate(const Invocation& invocation) {
  Evaluation evaluation(invocation, invocation.inputs.at("target").front());
  const SequenceRead& read = invocation.get<SequenceRead>("source");
  const std::vector<std::int64_t>& counts = invocation.parameters.integers("k");
  const double steps = static_cast<double>(counts.size()) + 1;
  const EvaluationRow full = evaluation.full(part_of(invocation.progress, 0, 1 / steps)).row;
  std::vector<EvaluationRow> rows;
  for (const std::int64_t k : counts) {
    const double done = static_cast<double>(rows.size()) + 1;
    const Progress progress = part_of(invocation.progress, done / steps, (done + 1) / steps);
    const Stopwatch stopwatch;
    const Analysis analysis = analyse(invocation, read, evaluation.source().sequence,
                                      static_cast<int>(k), part_of(progress, 0, 0.7));
    const Regions regions = regions_of(invocation, analysis);
    const double seconds = stopwatch.seconds();
    rows.push_back(evaluation.by(regions, part_of(progress, 0.7, 1)).row);
    rows.back().k = static_cast<int>(k);
    rows.back().decompose_seconds = seconds;
  }
  rows.push_back(full);
  const Table table = table_of(rows);
  Outcome outcome;
  outcome.report = Json::parse(table.json()).dump();
  outcome.summary = text_of(rows);
  outcome.outputs["out"].push_back({"", table});
  return outcome;
}

/// One decomposition after the other, each followed by a transfer.
double memory_of_evaluate(const Invocation& invocation) {
  const SequenceRead& source = invocation.get<SequenceRead>("source");
  const auto& counts = invocation.parameters.integers("k");
  const double analysis =
      analysis_bytes(invocation, source, static_cast<int>(*std::ranges::max_element(counts)));
  const auto& target = std::get<BlendshapeModel>(invocation.inputs.at("target").front().data);
  return std::max(analysis,
                  alignment_bytes(invocation, source) + solution_bytes(invocation, source, target));
}

}  // namespace

Operation evaluate_operation() {
  Operation operation;
  operation.name = "evaluate";
  operation.summary = "The paper's Table I: error and time against the number of regions";
  operation.inputs = {
      {"source", DataKind::sequence, "sequence whose deformation is transferred"},
      {"target", DataKind::model, "model (MODEL or MODEL@identity=1.5) or mesh that receives it"}};
  operation.outputs = {{"out", DataKind::table, "the table: .csv or .json", true}};
  operation.parameters = region_parameters();
  for (const auto& group :
       {decomposition_parameters(30), alignment_parameters(), solving_parameters()}) {
    for (const Parameter& parameter : group) operation.parameters.push_back(parameter);
  }
  for (Parameter& parameter : operation.parameters) {
    if (parameter.name != "k") continue;
    parameter.kind = ParameterKind::integer_list;
    parameter.fallback = std::vector<std::int64_t>{10, 30, 40};
    parameter.help = "numbers of components, one row each";
  }
  operation.examples = {"evaluate take.npy actor/ -k 10,30,40",
                        "evaluate takes/ actor@identity007=2 -k 10,20,30,40,50 -o table.csv"};
  operation.run = run_evaluate;
  operation.memory = memory_of_evaluate;
  return operation;
}

}  // namespace mimetra
