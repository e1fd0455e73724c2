#include "toolkit/operations/evaluation.h"

#include "toolkit/mesh/progress.h"

namespace mimetra {

namespace {

/// Mean over frames and the selected triangles of the squared error.
double mean_over(const Eigen::VectorXd& per_triangle, const std::vector<int>& selected) {
  double sum = 0;
  for (const int triangle : selected) sum += per_triangle[triangle];
  return sum / static_cast<double>(selected.size());
}

/// MPE; none where the full transfer of a mesh of this size is exact up to rounding.
std::optional<double> percentage_error(double full, double k, double size) {
  constexpr double kRounding = 1e-12;
  if (full <= kRounding * size * kRounding * size) return {};
  return mean_percentage_error(full, k);
}

}  // namespace

Table table_of(const std::vector<EvaluationRow>& rows) {
  Table table;
  table.columns = {
      "k",         "vertices", "triangles",  "vertex_share",      "triangle_share",  "de_all",
      "de_region", "mpe_all",  "mpe_region", "decompose_seconds", "transfer_seconds"};
  for (const EvaluationRow& row : rows) {
    table.rows.push_back({row.k ? std::optional<double>(*row.k) : std::nullopt,
                          double(row.vertices), double(row.triangles), row.vertex_share,
                          row.triangle_share, row.de_all, row.de_region, row.mpe_all,
                          row.mpe_region, row.decompose_seconds, row.transfer_seconds});
  }
  return table;
}

Evaluation::Evaluation(const Invocation& invocation, const NamedData& target)
    : invocation_(invocation), target_(target), source_(prepare_source(invocation)) {
  check_target(source_.sequence, target_);
}

EvaluatedTransfer Evaluation::full(const Progress& progress) {
  const std::vector<int> all = all_triangles(source_.sequence.triangles());
  EvaluatedTransfer result{{}, solve(invocation_, source_, target_, {all, {}}, progress)};
  full_ = transfer_error(source_.sequence, result.solution.sequence, all);
  result.row.vertices = source_.sequence.vertices();
  result.row.triangles = static_cast<int>(all.size());
  result.row.de_all = result.row.de_region = full_.de_all;
  result.row.transfer_seconds = result.solution.seconds;
  return result;
}

EvaluatedTransfer Evaluation::by(const Regions& regions, const Progress& progress) const {
  EvaluatedTransfer result{
      {}, solve(invocation_, source_, target_, {regions.triangles, regions.inside}, progress)};
  const TransferError error =
      transfer_error(source_.sequence, result.solution.sequence, regions.triangles);
  EvaluationRow& row = result.row;
  row.vertices = regions.vertex_count();
  row.triangles = static_cast<int>(regions.triangles.size());
  row.vertex_share = regions.vertex_share();
  row.triangle_share = regions.triangle_share();
  row.de_all = error.de_all;
  row.de_region = error.de_region;
  const double size = result.solution.sequence.extent();
  row.mpe_all = percentage_error(full_.de_all, error.de_all, size);
  row.mpe_region =
      percentage_error(mean_over(full_.per_triangle, regions.triangles), error.de_region, size);
  row.transfer_seconds = result.solution.seconds;
  return result;
}

}  // namespace mimetra
