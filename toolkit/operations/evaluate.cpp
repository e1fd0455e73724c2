#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include <mimetra/operations/memory.h>
#include <mimetra/operations/report.h>
#include <mimetra/operations/solving.h>
#include <mimetra/operations/toolkit_operations.h>

namespace mimetra {

namespace {

/// One row of Table I; k is empty for the full transfer.
struct Row {
  std::optional<int> k;
  int vertices = 0;
  int triangles = 0;
  double vertex_share = 1;
  double triangle_share = 1;
  double de_all = 0;
  double de_region = 0;
  std::optional<double> mpe_all;
  std::optional<double> mpe_region;
  std::optional<double> decompose_seconds;
  double transfer_seconds = 0;
};

/// Mean over frames and the selected triangles of the squared error.
double mean_over(const Eigen::VectorXd& per_triangle, const std::vector<int>& selected) {
  double sum = 0;
  for (const int triangle : selected) sum += per_triangle[triangle];
  return sum / static_cast<double>(selected.size());
}

class Evaluation {
 public:
  explicit Evaluation(const Invocation& invocation)
      : invocation_(invocation),
        read_(invocation.get<SequenceRead>("source")),
        target_(invocation.inputs.at("target").front()),
        source_(prepare_source(invocation)) {
    check_target(source_.sequence, target_);
  }

  Row full(const Progress& progress) {
    const std::vector<int> all = all_triangles(source_.sequence.triangles());
    const Solution solution = solve(invocation_, source_, target_, {all, {}}, progress);
    full_ = transfer_error(source_.sequence, solution.sequence, all);
    Row row;
    row.vertices = source_.sequence.vertices();
    row.triangles = static_cast<int>(all.size());
    row.de_all = row.de_region = full_.de_all;
    row.transfer_seconds = solution.seconds;
    return row;
  }

  /// \pre full() was called
  Row regions(int k, const Progress& progress) {
    const Stopwatch stopwatch;
    const Analysis analysis =
        analyse(invocation_, read_, source_.sequence, k, part_of(progress, 0, 0.7));
    const Regions regions = regions_of(invocation_, analysis);
    Row row;
    row.decompose_seconds = stopwatch.seconds();
    const Solution solution = solve(invocation_, source_, target_,
                                    {regions.triangles, regions.inside}, part_of(progress, 0.7, 1));
    const TransferError error =
        transfer_error(source_.sequence, solution.sequence, regions.triangles);
    row.k = k;
    row.vertices = regions.vertex_count();
    row.triangles = static_cast<int>(regions.triangles.size());
    row.vertex_share = regions.vertex_share();
    row.triangle_share = regions.triangle_share();
    row.de_all = error.de_all;
    row.de_region = error.de_region;
    row.mpe_all = mean_percentage_error(full_.de_all, error.de_all);
    row.mpe_region =
        mean_percentage_error(mean_over(full_.per_triangle, regions.triangles), error.de_region);
    row.transfer_seconds = solution.seconds;
    return row;
  }

 private:
  const Invocation& invocation_;
  const SequenceRead& read_;
  const NamedData& target_;
  PreparedSource source_;
  TransferError full_;
};

Table table_of(const std::vector<Row>& rows) {
  Table table;
  table.columns = {
      "k",         "vertices", "triangles",  "vertex_share",      "triangle_share",  "de_all",
      "de_region", "mpe_all",  "mpe_region", "decompose_seconds", "transfer_seconds"};
  for (const Row& row : rows) {
    table.rows.push_back({row.k ? std::optional<double>(*row.k) : std::nullopt,
                          double(row.vertices), double(row.triangles), row.vertex_share,
                          row.triangle_share, row.de_all, row.de_region, row.mpe_all,
                          row.mpe_region, row.decompose_seconds, row.transfer_seconds});
  }
  return table;
}

std::string text_of(const std::vector<Row>& rows) {
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
  for (const Row& row : rows) {
    text += row.k ? cell(*row.k, "%.0f", 4) : "full";
    text += cell(row.vertices, "%.0f", 10) + cell(row.triangles, "%.0f", 11) +
            cell(100 * row.triangle_share, "%.1f %%", 8) + cell(row.de_all, "%.6g", 13) +
            cell(row.mpe_all, "%.3f", 10) + cell(row.de_region, "%.6g", 13) +
            cell(row.mpe_region, "%.3f", 10) + cell(row.decompose_seconds, "%.3f", 11) +
            cell(row.transfer_seconds, "%.3f", 12) + '\n';
  }
  return text;
}

Outcome run(const Invocation& invocation) {
  Evaluation evaluation(invocation);
  const std::vector<std::int64_t>& counts = invocation.parameters.integers("k");
  const double steps = static_cast<double>(counts.size()) + 1;
  const Row full = evaluation.full(part_of(invocation.progress, 0, 1 / steps));
  std::vector<Row> rows;
  for (const std::int64_t k : counts) {
    const double done = static_cast<double>(rows.size()) + 1;
    rows.push_back(evaluation.regions(
        static_cast<int>(k), part_of(invocation.progress, done / steps, (done + 1) / steps)));
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
double memory(const Invocation& invocation) {
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
  operation.run = run;
  operation.memory = memory;
  return operation;
}

}  // namespace mimetra
