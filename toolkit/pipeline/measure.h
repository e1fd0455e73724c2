#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/pipeline/region_choice.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// RMS of TransferError::crease, in degrees, from which people see a crease at the regions' border.
/// On drawn faces of sfm, ict-face and facecap a crease of 2 is hardly found, one of 4 is. The full
/// transfer has 0.1 to 1.1.
constexpr double kVisibleCrease = 3;

/// Error of a solution against its source, before head motion is given back. Throws what
/// transfer_error() and closed_seams() throw. \pre as for solve(), with the same options
TransferError error_of(const Solution& solution, const Source& source, const Target& target,
                       const Selection& selection, const SolveOptions& options = {},
                       const Context& context = {});

/// Notes a visible crease at the regions' border, under the target's name (Topic::visible_crease).
void note_crease(const TransferError& error, const Target& target, const Context& context);

/// Limits of a usable result. Sound results miss 0.1 to 4 % of the deformation and flip 1 to 5
/// triangles of 100 000. Results that look wrong miss 8 % and more, or flip 40 and more.
constexpr double kUnusableMissedShare = 0.08;
constexpr double kUnusableFlippedShare = 2e-4;

/// Says what is wrong with a result before head motion is given back: "9 % of the deformation is
/// missing". Empty if nothing is wrong.
std::string unusable_by(const TransferError& error);

/// One row of the paper's Table I. Vertices, triangles and their shares are the source's.
struct EvaluationRow {
  /// Number of components, or of discs chosen for the transfer. None for the full transfer and for
  /// given regions.
  std::optional<int> k;
  /// How the regions were chosen. None for the full transfer and for given regions.
  std::optional<Selector> by = {};
  int vertices = 0;
  int triangles = 0;
  double vertex_share = 1;
  double triangle_share = 1;
  /// Radius of the source's regions, a length, without added discs. None for the full transfer, and
  /// if the radii differ.
  std::optional<double> radius;
  double de_all = 0;
  double de_region = 0;
  std::optional<double> mpe_all;  ///< percent; none for the full transfer, or if that is exact
  std::optional<double> mpe_region;
  std::optional<double> decompose_seconds;  ///< decomposition and choice of regions
  double transfer_seconds = 0;
  std::optional<bool> converged = {};  ///< the decomposition; none if there was none
  /// As in TransferError, on the target.
  double leak = 0;
  double crease = 0;
  double largest_crease = 0;
};

/// A transfer and its error against the source's deformation.
struct EvaluatedTransfer {
  EvaluationRow row;
  Solution solution;
  TransferError error;
  /// Regions of the source, with their border (with_border()). Empty for a transfer by all
  /// triangles.
  Regions regions = {};
};

/// Transfers by all triangles. Throws as solve(). \pre the target is a MatchedTarget
EvaluatedTransfer evaluate_full(const Source& source, const Target& target,
                                const SolveOptions& options = {}, const Context& context = {});

/// Transfers by regions and compares the error with `full`. Throws what bordered_selection() and
/// solve() throw. \pre the target is a MatchedTarget
EvaluatedTransfer evaluate_by(const Regions& regions, const EvaluatedTransfer& full,
                              const Source& source, const Target& target,
                              const SolveOptions& options = {}, const Context& context = {});

struct EvaluationOptions {
  /// Numbers of components, each >= 1, one row each. With Selector::transfer, the largest numbers
  /// of discs; an empty list gives one row with any number of discs.
  std::vector<int> counts = {10, 30, 40};
  /// Instead of these rows, computes two curves of error against the share of triangles, from 0.1
  /// to 0.8. One curve uses the strongest regions, the other the regions chosen for the transfer.
  /// The curves ignore regions.select and regions.triangles.
  bool curve = false;
  /// Instead, computes one row with these regions.
  std::optional<GivenRegions> given = {};
  /// Options of the steps. `counts` gives the numbers of components, so analysis.count must be the
  /// default.
  SourceOptions source = {};
  AnalysisOptions analysis = {};
  RegionChoiceOptions regions = {};
  SolveOptions solve = {};

  /// This many discs of the usual radius contain most of a face.
  static constexpr int kCurveComponents = 80;

  static constexpr Option kCounts{"counts", &EvaluationOptions::counts, {.minimum = 1}};
  static constexpr Option kCurve{"curve", &EvaluationOptions::curve};
  static constexpr auto declared() { return std::tuple(kCounts, kCurve); }
};

/// Computes the paper's Table I: one row for each number of components, or of discs. The last row
/// is the transfer by all triangles. Throws what prepare_source(), MatchedTarget(), analyse(),
/// choose_regions(), check_regions(), check_border(), RegionSelector, bordered_selection() and
/// solve() throw.
std::vector<EvaluationRow> evaluate(const FrameSource& source, const Target& target,
                                    const EvaluationOptions& options = {},
                                    const Context& context = {});

// Peak memory of the steps in bytes, without their inputs. The functions count the arrays that grow
// with the sequence or the number of components.

/// Bytes of all frames.
double frame_bytes(const FrameSource& sequence);

/// Bytes that simplify() needs.
double simplify_bytes(const FrameSource& sequence);

/// Bytes of a stored() sequence that stay in memory; 0 for a source that is quick to read.
double stored_bytes(const FrameSource& sequence);

/// Plan that keeps analyse() within the memory of its context, on this process. Throws as
/// planned_decomposition() and beside_distances() do.
DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context);

/// Bytes that choosing regions for a transfer to `target` needs.
double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target);

/// Bytes of the set-up and the result of a transfer to `target`.
double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context);

/// Additional bytes if each of `regions` regions has its own weights.
double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context);

}  // namespace mimetra
