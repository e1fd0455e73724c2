#pragma once

#include <Eigen/Core>

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

}  // namespace mimetra
