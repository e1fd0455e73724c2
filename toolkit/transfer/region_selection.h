#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/regions/disc_search.h"
#include "toolkit/transfer/disc_choice.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

struct RegionSelectionOptions {
  /// Of DiscChoice: what other clips may bring beside this one's own residual.
  double noise = 10;
  EdgeSum edges = EdgeSum::all;
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kNoise{"noise", &RegionSelectionOptions::noise, {.minimum = 1e-6}};
  static constexpr Option kEdges{"edges", &RegionSelectionOptions::edges};
  static constexpr auto declared() { return std::tuple(kNoise, kEdges); }
};

/// How much may be chosen.
struct SelectionBound {
  /// Share of the source's triangles, above 0 and at most 1.
  double share = 1;
  /// Number of discs; none for any.
  std::optional<int> count = {};
};

/// Discs of a source by which the weights of a target are nearest to those of all its triangles:
/// one after the other the disc with the largest fall of log J (DiscChoice) for each triangle of
/// the source that it adds.
///
/// The constructor solves eq. 10 by all triangles and keeps what remains, 6 M x F numbers. After
/// that everything is algebra in D unknowns. Queries are const.
class RegionSelection {
 public:
  /// `performance` is the source where the target is, F >= 1 frames with its neutral as rest pose.
  /// Keeps a reference to the target. Throws what BlendshapeTransfer and reading throw, and
  /// std::invalid_argument for options out of range.
  RegionSelection(const FrameSource& performance, const BlendshapeModel& target,
                  const RegionSelectionOptions& options = {}, const Context& context = {});

  /// Numbers of the chosen discs, in their order; none where no disc fits into the bound. Where
  /// discs are equally good, the first is taken. The triangles of each are the source's, ascending.
  /// Throws std::invalid_argument for a bound out of range, Cancelled.
  std::vector<int> choose(std::span<const Disc> discs, const SelectionBound& bound = {},
                          const Context& context = {}) const;

  /// J of triangles of the target; those without partner show nothing.
  double criterion(const std::vector<int>& triangles) const;

 private:
  class Greedy;

  Sight sight_of(std::span<const int> triangles) const;

  const BlendshapeModel& target_;
  RegionSelectionOptions options_;
  std::vector<int> row_of_;  // of each triangle of the target among those that count, or -1
  Eigen::MatrixXd unmet_;    // what remains of what is wanted (6 T x F)
  std::optional<DiscChoice> choice_;
};

}  // namespace mimetra
