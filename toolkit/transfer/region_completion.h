#pragma once

#include <memory>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/regions/discs.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

struct CompletionOptions {
  /// Share of each expression's motion G_jj (eq. 11) that the regions are to see; 0 leaves them as
  /// they are. On seven other heads, K = 10 regions of a real capture have an MPE of -4 to -23 %
  /// with 0.05, of -2 to -4 % with 0.3.
  double share = 0.3;
  /// Share of the target's triangles that may be added.
  double limit = 0.25;
  EdgeSum edges = EdgeSum::all;
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kShare{
      "share", &CompletionOptions::share, {.minimum = 0, .maximum = 0.95}};
  static constexpr Option kLimit{"limit", &CompletionOptions::limit, {.minimum = 0, .maximum = 1}};
  static constexpr Option kEdges{"edges", &CompletionOptions::edges};
  static constexpr auto declared() { return std::tuple(kShare, kLimit, kEdges); }
};

struct CompletedRegions {
  Regions regions;
  /// Discs that were added: the last of `regions`.
  int added = 0;
  /// Whether the limit was reached before all expressions were seen.
  bool limited = false;
};

/// Adds discs to regions of a source until they see each of the target's expressions, and tell them
/// apart (condition number of G_L up to kPoorCondition): the one that holds most of what is unseen
/// of the expression that is seen least, then of the combination that is. Expressions that move
/// nothing are passed over; of the others counts what they move where discs may lie. Throws
/// std::invalid_argument for options out of range, and what the search throws. \pre the regions
/// and the search are of one connectivity, the target of the same or paired with it
CompletedRegions completed(const Regions& regions, const BlendshapeModel& target,
                           DiscSearch& search, const CompletionOptions& options = {});

}  // namespace mimetra
