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
#include "toolkit/regions/discs.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// Contribution of triangles L to the fit of a target's expressions. G_L = sum of A_i^T A_i
/// (eq. 11, D x D). H_L = sum of A_i^T r_i (D x F) is the pull of the residual r on the weights.
/// The residual is the source's deformation that remains after a fit to all triangles.
struct Sight {
  Eigen::MatrixXd gram;
  Eigen::MatrixXd pull;

  static Sight none(Eigen::Index expressions, Eigen::Index frames);
  Sight& operator+=(const Sight& more);
};

/// Distance between the weights from triangles L and from all triangles, measured by the motion
/// they cause:
///
///   J(L) = 1/F sum_f |G^(1/2) G_L^-1 h_L,f|^2 + noise s^2 tr(G_L^-1 G)
///
/// G is over all triangles, and s^2 is the mean square of their residual r. The first term is the
/// error of L on this clip: its unbounded weights move by G_L^-1 h_L. The second term is the
/// expected error on clips whose squared residual is `noise` times this clip's. It is the
/// V-optimality criterion [Pukelsheim. Optimal Design of Experiments. 1993]. A ridge keeps J finite
/// for expressions that L does not show. The unit is length squared.
class DiscChoice {
 public:
  /// Ridge as a share of the mean diagonal of G.
  static constexpr double kRidge = 1e-6;

  /// `gram` is G (D x D), and `variance` is s^2 > 0. \pre G has a diagonal entry above 0
  DiscChoice(Eigen::MatrixXd gram, double variance, double noise);

  /// J, above 0.
  double criterion(const Sight& of_regions) const;

 private:
  Eigen::MatrixXd gram_;
  double ridge_;
  double variance_;  // noise s^2
};

struct RegionSelectionOptions {
  /// Factor `noise` of DiscChoice: the squared residual of other clips relative to this one's.
  double noise = 10;
  EdgeSum edges = EdgeSum::all;
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kNoise{"noise", &RegionSelectionOptions::noise, {.minimum = 1e-6}};
  static constexpr Option kEdges{"edges", &RegionSelectionOptions::edges};
  static constexpr auto declared() { return std::tuple(kNoise, kEdges); }
};

struct SelectionBound {
  /// Largest share of the source's triangles, above 0 and at most 1.
  double share = 1;
  /// Largest number of discs; empty for no limit.
  std::optional<int> count = {};
};

/// Selects discs of a source so that the weights of a target come closest to the weights from all
/// triangles. Each step adds the disc with the largest fall of log J (DiscChoice) per triangle that
/// it adds.
///
/// The constructor solves eq. 10 with all triangles and keeps the residual, 6 M x F numbers.
/// Everything after that is algebra in D unknowns. Queries are const.
class RegionSelection {
 public:
  /// `performance` is the source, placed over the target. It has F >= 1 frames, and its neutral is
  /// the rest pose. Keeps a reference to the target. Throws what BlendshapeTransfer and reading
  /// throw, and std::invalid_argument if an option is out of range.
  RegionSelection(const FrameSource& performance, const BlendshapeModel& target,
                  const RegionSelectionOptions& options = {}, const Context& context = {});

  /// Numbers of the chosen discs in the order of choice, empty if no disc fits into the bound. Of
  /// equally good discs, the first is taken. Throws std::invalid_argument if the bound is out of
  /// range, and Cancelled. \pre the triangles of each disc are the source's, ascending
  std::vector<int> choose(std::span<const Disc> discs, const SelectionBound& bound = {},
                          const Context& context = {}) const;

  /// J for triangles of the target. Triangles without a partner contribute nothing.
  double criterion(const std::vector<int>& triangles) const;

 private:
  class Greedy;

  Sight sight_of(std::span<const int> triangles) const;

  const BlendshapeModel& target_;
  RegionSelectionOptions options_;
  std::vector<int> row_of_;  // index of each target triangle among those with a partner, or -1
  Eigen::MatrixXd unmet_;    // the residual r (6 T x F)
  std::optional<DiscChoice> choice_;
};

}  // namespace mimetra
