#pragma once

#include <optional>

#include "toolkit/pipeline/solution.h"
#include "toolkit/transfer/region_completion.h"

namespace mimetra {

/// Completes regions of one source for several targets: discs of half their radius are added until
/// they see every expression of a target.
class RegionCompleter {
 public:
  /// Distances along the source's rest pose are made, as the options of the analysis say, when they
  /// are needed first.
  RegionCompleter(const Source& source, const RegionChoiceOptions& options,
                  const AnalysisOptions& analysis);
  RegionCompleter(const Analysis& analysis, const RegionChoiceOptions& options);

  /// The regions themselves where a target is solved for vertices, or for weights of each region,
  /// which look at all triangles; and those whose border is soft, which somebody painted as they
  /// are. Where the options bound the share of the triangles, the weakest
  /// regions make room for the discs that are added, the last one apart, beside which as many are
  /// added as fit. Notes, under the target's name, what was added and left out
  /// (Topic::completed_regions). Throws what completed() throws.
  Regions operator()(const Regions& regions, const Target& target, const SolveOptions& options,
                     const Context& context = {});

 private:
  /// The most regions with the discs that complete them, within `bound` as a share of the
  /// triangles.
  CompletedRegions completed_within(double bound, const Regions& regions, const Target& target,
                                    const CompletionOptions& options);

  Positions rest_;
  Triangles triangles_;
  RegionChoiceOptions options_;
  double radius_;
  std::vector<bool> inside_;  // where discs may lie, or empty
  DistanceOptions of_distances_;
  DistanceFunction distances_;  // or empty
  std::optional<DiscSearch> search_;
};

}  // namespace mimetra
