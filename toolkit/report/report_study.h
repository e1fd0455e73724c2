#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

/// What a report shows of a transfer.
struct ReportedTransfer {
  std::string target;
  std::vector<std::string> expressions;  ///< of the target, for a solution of weights
  MeshSequence full;
  MeshSequence by_regions;
  std::vector<int> regions_of_vertices;  ///< strongest region over each vertex, -1 outside
  Eigen::MatrixXd weights;               ///< of the one by regions, F x D; empty in vertex space
  std::vector<EvaluationRow> rows;       ///< ascending in K, all triangles last
  std::size_t main_row = 0;              ///< the run's own
  /// How many times larger than it is the target is shown: 1, unless its unit of length seems to be
  /// another than the source's. Both sequences are enlarged.
  double shown_scale = 1;
};

/// What a report shows of a run, found by doing it again. Sequences have their neutral as rest pose
/// and no head motion.
struct ReportStudy {
  RunRecord run;
  std::string source;
  MeshSequence sequence;
  bool moved_head = false;  ///< head motion was taken out
  Regions regions;
  std::optional<Components> components;  ///< none for regions that were given
  std::optional<ReportedTransfer> transfer;
  std::vector<std::string> notes;  ///< what the run warned of
};

/// The strongest region of each vertex of the source (N), -1 outside.
std::vector<int> strongest_regions(const Regions& regions);

/// K of a run that looked for regions; of several the largest.
int main_count(const Parameters& parameters);

/// `counts`: numbers of components that the table has besides the run's own; those above what the
/// mesh can have are left out. Throws what the run's operation throws.
ReportStudy study(const NamedData& run, const std::vector<int>& counts, const Log& log = {},
                  const Context& context = {});

}  // namespace mimetra
