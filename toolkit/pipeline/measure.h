#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/pipeline/region_choice.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// RMS of TransferError::crease, in degrees, from which a crease at the regions' border is seen. On
/// drawn faces of sfm, ict-face and facecap one of 2 is hardly found, one of 4 is; the full
/// transfer has 0.1 to 1.1.
constexpr double kVisibleCrease = 3;

/// How far a solution is from what it was solved for, before head motion is given back. \pre as of
/// solve(), with the same options.
/// Throws what transfer_error() and closed_seams() throw.
TransferError error_of(const Solution& solution, const Source& source, const Target& target,
                       const Selection& selection, const SolveOptions& options = {},
                       const Context& context = {});

/// Notes, under the target's name, a crease at the regions' border that is seen
/// (Topic::visible_crease).
void note_crease(const TransferError& error, const Target& target, const Context& context);

/// Sound results miss 0.1 to 4 % of the deformation and flip 1 to 5 triangles of 100 000; results
/// that people see to be wrong, 8 % and more, or 40 and more.
constexpr double kUnusableMissedShare = 0.08;
constexpr double kUnusableFlippedShare = 2e-4;

/// What is wrong with a result before head motion is given back: "9 % of the deformation is
/// missing"; empty for nothing.
std::string unusable_by(const TransferError& error);

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

// Peak memory of the steps in bytes, without their inputs. The functions count the arrays that grow
// with the sequence or the number of components.

/// All frames in memory.
double frame_bytes(const FrameSource& sequence);

/// Bytes that simplify() takes.
double simplify_bytes(const FrameSource& sequence);

/// Bytes of a stored() sequence that stay in memory; 0 for a source that is quick to read.
double stored_bytes(const FrameSource& sequence);

/// How analyse() keeps within the memory of its context, on this process. Throws as
/// planned_decomposition().
DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context);

/// Bytes that the choice of regions for a transfer to `target` takes.
double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target);

/// Bytes of the set-up and the result of a transfer to `target`.
double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context);

/// Further bytes if each of `regions` regions has its own weights.
double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context);

}  // namespace mimetra
