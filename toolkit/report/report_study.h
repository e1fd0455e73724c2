#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

/// Results of a transfer for a report.
struct ReportedTransfer {
  std::string target;
  std::vector<std::string> expressions;  ///< target's expressions, if the solution has weights
  MeshSequence full;
  MeshSequence by_regions;
  std::vector<int> regions_of_vertices;  ///< strongest region over each vertex, -1 outside
  Eigen::MatrixXd weights;  ///< weights of the transfer by regions, F x D; empty in vertex space
  std::vector<EvaluationRow> rows;  ///< ascending in K, all triangles last
  std::size_t main_row = 0;         ///< row of the run itself
  /// Enlargement of the target and both its sequences. It is 1 unless the target's unit of length
  /// seems to differ from the source's.
  double shown_scale = 1;
};

/// Results of a run for a report, computed by repeating the run. Rest poses are the neutral, and
/// head motion is removed.
struct ReportStudy {
  RunRecord run;
  std::string source;
  MeshSequence sequence;
  bool moved_head = false;  ///< whether head motion was removed
  Regions regions;
  std::optional<Components> components;  ///< none for given regions
  std::optional<ReportedTransfer> transfer;
  std::vector<std::string> notes;  ///< warnings of the run
};

/// Strongest region of each vertex of the source (N), -1 outside.
std::vector<int> strongest_regions(const Regions& regions);

/// Number of components K of a run that looked for regions; the largest of several.
int main_count(const Parameters& parameters);

/// Repeats a run. `counts` are further numbers of components for the table; counts that the mesh
/// cannot have are left out. Throws as the run's operation.
ReportStudy study(const NamedData& run, const std::vector<int>& counts, const Log& log = {},
                  const Context& context = {});

}  // namespace mimetra
