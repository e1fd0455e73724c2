#pragma once

#include <optional>
#include <vector>

#include "toolkit/pipeline/solution.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// One row of the paper's Table I. Vertices, triangles and their shares are the source's.
struct EvaluationRow {
  /// Number of components, or of discs that were chosen for the transfer; none for the full
  /// transfer and for given regions.
  std::optional<int> k;
  /// By what the regions were chosen; none for the full transfer and for given regions.
  std::optional<Selector> by = {};
  int vertices = 0;
  int triangles = 0;
  double vertex_share = 1;
  double triangle_share = 1;
  /// Of the source's regions, length; none for the full transfer, and where they differ.
  std::optional<double> radius;
  double de_all = 0;
  double de_region = 0;
  std::optional<double> mpe_all;  ///< percent; none for the full one, or where that is exact
  std::optional<double> mpe_region;
  std::optional<double> decompose_seconds;  ///< decomposition and choice of regions
  double transfer_seconds = 0;
  std::optional<bool> converged = {};  ///< the decomposition; none where there was none
  /// Of TransferError, on the target.
  double leak = 0;
  double crease = 0;
  double largest_crease = 0;
};

/// A transfer, and how far it is from the source's deformation.
struct EvaluatedTransfer {
  EvaluationRow row;
  Solution solution;
  TransferError error;
  /// Of the source, with_border() that they have; none of a transfer by all triangles.
  Regions regions = {};
};

/// The transfer by all triangles. \pre a MatchedTarget. Throws as solve().
EvaluatedTransfer evaluate_full(const Source& source, const Target& target,
                                const SolveOptions& options = {}, const Context& context = {});

/// The transfer by regions, beside the one by all triangles. \pre a MatchedTarget. Throws what
/// bordered_selection() and solve() throw.
EvaluatedTransfer evaluate_by(const Regions& regions, const EvaluatedTransfer& full,
                              const Source& source, const Target& target,
                              const SolveOptions& options = {}, const Context& context = {});

struct EvaluationOptions {
  /// Numbers of components, each >= 1: one row each. With Selector::transfer the most discs; none
  /// for one row of any number.
  std::vector<int> counts = {10, 30, 40};
  /// Instead of these rows two curves, error against share of triangles from a tenth to eight: the
  /// strongest regions, and those that are chosen for the transfer. The regions' choice and bound
  /// do not count.
  bool curve = false;
  /// One row by these regions instead.
  std::optional<GivenRegions> given = {};
  /// The steps. `counts` gives the numbers of components, so analysis.count must be the default.
  SourceOptions source = {};
  AnalysisOptions analysis = {};
  RegionChoiceOptions regions = {};
  SolveOptions solve = {};

  /// So many discs of the usual radius hold most of a face.
  static constexpr int kCurveComponents = 80;

  static constexpr Option kCounts{"counts", &EvaluationOptions::counts, {.minimum = 1}};
  static constexpr Option kCurve{"curve", &EvaluationOptions::curve};
  static constexpr auto declared() { return std::tuple(kCounts, kCurve); }
};

/// The paper's Table I: a row for each number of components, or of discs, and one by all triangles,
/// which is the last. Throws what prepare_source(), MatchedTarget(), analyse(), choose_regions(),
/// check_regions(), check_border(), RegionSelector, bordered_selection() and solve() throw.
std::vector<EvaluationRow> evaluate(const FrameSource& source, const Target& target,
                                    const EvaluationOptions& options = {},
                                    const Context& context = {});

}  // namespace mimetra
