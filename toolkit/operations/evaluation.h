#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/progress.h"
#include "toolkit/operations/solving.h"

namespace mimetra {

/// One row of the paper's Table I.
struct EvaluationRow {
  std::optional<int> k;  ///< number of components; none for the full transfer and for given regions
  int vertices = 0;
  int triangles = 0;
  double vertex_share = 1;
  double triangle_share = 1;
  double de_all = 0;
  double de_region = 0;
  std::optional<double> mpe_all;  ///< percent; none for the full transfer, or where it is exact
  std::optional<double> mpe_region;
  std::optional<double> decompose_seconds;
  double transfer_seconds = 0;
};

Table table_of(const std::vector<EvaluationRow>& rows);

/// A transfer, and how far it is from the source's deformation.
struct EvaluatedTransfer {
  EvaluationRow row;
  Solution solution;
};

/// Transfers of one source to one target by different regions, beside the one by all triangles.
class Evaluation {
 public:
  /// Prepares the input `source` of a call with solving_parameters(). Keeps references. Throws
  /// MismatchError where the target has other vertices or faces.
  Evaluation(const Invocation& invocation, const NamedData& target);

  const Alignment& source() const { return source_; }
  EvaluatedTransfer full(const Progress& progress);
  /// \pre full() was called
  EvaluatedTransfer by(const Regions& regions, const Progress& progress) const;

 private:
  const Invocation& invocation_;
  const NamedData& target_;
  Alignment source_;
  TransferError full_;
};

}  // namespace mimetra
