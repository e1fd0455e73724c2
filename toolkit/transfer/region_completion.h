#pragma once

#include <memory>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/regions/discs.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

struct CompletionOptions {
  /// Share of each expression's motion G_jj (eq. 11) that the regions should show. 0 leaves the
  /// regions unchanged. Measured on seven other heads with K = 10 regions of a real capture: the
  /// MPE is -4 to -23 % with 0.05, and -2 to -4 % with 0.3.
  double share = 0.3;
  /// Most triangles that may be added, as a share of the target's.
  double limit = 0.25;
  EdgeSum edges = EdgeSum::all;
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kShare{
      "share", &CompletionOptions::share, {.minimum = 0, .maximum = 0.95}};
  static constexpr Option kLimit{"limit", &CompletionOptions::limit, {.minimum = 0, .maximum = 1}};
  static constexpr Option kEdges{"edges", &CompletionOptions::edges};
  static constexpr auto declared() { return std::tuple(kShare, kLimit, kEdges); }
};

struct CompletedRegions {
  Regions regions;
  /// Number of added discs, which are the last of `regions`.
  int added = 0;
  /// True if the limit was reached before the regions showed all expressions.
  bool limited = false;
};

/// Adds discs to regions of a source until they show each of the target's expressions and
/// distinguish between them. The second condition holds if the condition number of G_L is at most
/// kPoorCondition.
///
/// Each disc is the best for one expression, the one with the least visible share: it contains most
/// of the expression's unseen motion. Later discs serve the least visible combination of
/// expressions. Expressions without motion are skipped. Of the others, only motion where discs may
/// lie counts.
///
/// Throws std::invalid_argument if an option is out of range, and what the search throws. \pre the
/// regions and the search have one connectivity; the target has the same or is paired with it
CompletedRegions completed(const Regions& regions, const BlendshapeModel& target,
                           DiscSearch& search, const CompletionOptions& options = {});

}  // namespace mimetra
