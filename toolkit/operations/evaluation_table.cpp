#include "toolkit/operations/evaluation_table.h"

namespace mimetra {

Table table_of(const std::vector<EvaluationRow>& rows) {
  Table table;
  table.columns = {"k",
                   "vertices",
                   "triangles",
                   "vertex_share",
                   "triangle_share",
                   "radius",
                   "de_all",
                   "de_region",
                   "mpe_all",
                   "mpe_region",
                   "decompose_seconds",
                   "transfer_seconds",
                   "converged",
                   "leak",
                   "crease",
                   "largest_crease"};
  table.word_column = "by";
  table.picture = {"triangle_share",        "de_all",
                   "Error against regions", "share of the triangles",
                   "DE (length squared)",   "all triangles"};
  for (const EvaluationRow& row : rows) {
    table.words.emplace_back(row.by ? choice_name(*row.by) : "");
    table.rows.push_back({row.k ? std::optional<double>(*row.k) : std::nullopt,
                          double(row.vertices), double(row.triangles), row.vertex_share,
                          row.triangle_share, row.radius, row.de_all, row.de_region, row.mpe_all,
                          row.mpe_region, row.decompose_seconds, row.transfer_seconds,
                          row.converged ? std::optional<double>(*row.converged) : std::nullopt,
                          row.leak, row.crease, row.largest_crease});
  }
  return table;
}

}  // namespace mimetra
