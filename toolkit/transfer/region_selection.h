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

/// What triangles L show of a target's expressions: G_L = sum of A_i^T A_i (eq. 11, D x D), and the
/// pull H_L = sum of A_i^T r_i (D x F) on their weights of what remains of the source's deformation
/// when all triangles have been fitted.
struct Sight {
  Eigen::MatrixXd gram;
  Eigen::MatrixXd pull;

  /// Of no triangle.
  static Sight none(Eigen::Index expressions, Eigen::Index frames);
  Sight& operator+=(const Sight& more);
};

/// How far the weights that triangles L give are from those of all triangles, where it counts:
///
///   J(L) = 1/F sum_f |G^(1/2) G_L^-1 h_L,f|^2 + noise s^2 tr(G_L^-1 G)
///
/// with G of all triangles and s^2 the mean square of their residual r. The first term is what L
/// mistakes of this clip: its unbounded weights move by G_L^-1 h_L. The second is what it would
/// mistake on average of clips with a residual of `noise` times this one's size squared, which is
/// the choice by V-optimality [Pukelsheim. Optimal Design of Experiments. 1993]. A ridge keeps
/// expressions that L does not show finite. Unit of length squared.
class DiscChoice {
 public:
  /// As a share of the mean diagonal of G.
  static constexpr double kRidge = 1e-6;

  /// `gram` G, D x D; `variance` s^2 > 0. \pre G has a diagonal entry above 0
  DiscChoice(Eigen::MatrixXd gram, double variance, double noise);

  /// J, above 0.
  double criterion(const Sight& of_regions) const;

 private:
  Eigen::MatrixXd gram_;
  double ridge_;
  double variance_;  // noise s^2
};

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
