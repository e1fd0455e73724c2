#pragma once

#include <span>
#include <vector>

#include "toolkit/pipeline/solution.h"
#include "toolkit/transfer/region_selection.h"

namespace mimetra {

/// Regions of one source that are chosen for the transfer to a target (RegionSelection), for
/// several targets: discs of kDiscRadius times the radius of the options, of which kCandidates lie
/// around vertices that are far from each other.
class RegionSelector {
 public:
  /// Measured on faces of several models: smaller discs follow what is needed, larger ones tell
  /// each region's place better.
  static constexpr double kDiscRadius = 0.35;
  static constexpr int kCandidates = 400;
  /// Frames that are looked at, evenly spread over the clip where it has more.
  static constexpr int kMostFrames = 100;

  /// Discs lie on the source's moving_parts(), or where the analysis says. `source` gives the
  /// surface along which distances run, as the options of the analysis say; they are made when they
  /// are needed first. Throws std::invalid_argument for options out of range.
  RegionSelector(const Source& source, const RegionChoiceOptions& options,
                 const AnalysisOptions& analysis);

  /// The regions for a target, in the order in which they were chosen, with the share of the
  /// vertices' motion that they hold as energy. Where all discs hold less than the share of the
  /// triangles that was asked for, that is noted under the target's name (Topic::few_discs).
  ///
  /// Throws OptionError (Topic::no_selection) for a target that is solved for vertices and
  /// (Topic::triangle_bound) where no disc fits, Cancelled, and what RegionSelection and distances
  /// throw. \pre the target is a MatchedTarget, the source is placed_at() it
  Regions operator()(const Source& source, const Target& target, const SolveOptions& options,
                     const Context& context = {});
  /// The same for several bounds instead of that of the options.
  std::vector<Regions> within(std::span<const SelectionBound> bounds, const Source& source,
                              const Target& target, const SolveOptions& options,
                              const Context& context = {});

 private:
  const std::vector<Disc>& candidates(const Context& context);

  Positions rest_;
  Triangles triangles_;
  RegionChoiceOptions options_;
  DistanceOptions of_distances_;
  double radius_ = 0;
  std::vector<bool> inside_;  // where discs may lie, or empty
  std::vector<Disc> candidates_;
};

/// How much the options let be chosen for a transfer.
SelectionBound selection_bound(const RegionChoiceOptions& options);

/// Throws OptionError (Topic::no_selection) where regions are to be chosen for a target that is
/// solved for vertices.
void check_selection(const Target& target, const RegionChoiceOptions& regions, Space space);

}  // namespace mimetra
