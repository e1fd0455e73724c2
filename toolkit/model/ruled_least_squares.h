#pragma once

#include <Eigen/Core>

#include "toolkit/model/weight_rules.h"

namespace mimetra {

/// Bounded least squares under rules: for each right-hand side h, the x that minimises
///   x^T G x / 2 - h^T x + pair_weight / 2 * sum over pairs of (x_a - x_b)^2
/// over lower <= x <= upper, with at most one unknown of each exclusive group away from its value
/// `off`. The unknowns may be any: a model's weights, or those of each of its regions.
///
/// Pairs enter the matrix. Of exclusive groups it finds the best choice by branch and bound: a
/// choice whose problem without the groups that are still open is no better than the best one
/// found is left. Both are exact, to rounding. Queries are const.
///
/// [Land, Doig. An automatic method of solving discrete programming problems. Econometrica 28(3),
/// 1960]
class RuledLeastSquares {
 public:
  /// `gram` D x D, symmetric positive semidefinite. Throws std::invalid_argument where sizes
  /// disagree, a number of an unknown is out of range, bounds cross, or `off` of an unknown in a
  /// group is not within its bounds.
  RuledLeastSquares(Eigen::MatrixXd gram, UnknownRules rules);

  /// x for `h` (D); `start` (D, or empty) changes the time only. Of choices that are equally good,
  /// to 1e-12 of the energy, that with the lower unknown in the earlier group is taken. Throws as
  /// box_least_squares().
  Eigen::VectorXd operator()(const Eigen::VectorXd& h, const Eigen::VectorXd& start = {}) const;

  /// All rows of `h` (F x D) together, with mu |D2 x|^2 / 2 of second differences over `times`
  /// (smooth_weights()). `single` (F x D) are their solutions one by one, which choose of each
  /// group the unknown that may move in each frame; where none does there, that of the frame
  /// before, or of the first frame in which one does. Throws as smooth_weights().
  Eigen::MatrixXd smooth(const Eigen::MatrixXd& h, const Eigen::VectorXd& times, double mu,
                         const Eigen::MatrixXd& single) const;

  /// G with the pairs' part.
  const Eigen::MatrixXd& system() const { return system_; }
  const UnknownRules& rules() const { return rules_; }

 private:
  Eigen::MatrixXd system_;
  UnknownRules rules_;
};

}  // namespace mimetra
