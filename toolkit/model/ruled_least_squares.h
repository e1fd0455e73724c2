#pragma once

#include <Eigen/Core>

#include "toolkit/model/weight_rules.h"

namespace mimetra {

/// Bounded least squares under rules. For each right-hand side h, it finds the x that minimises
///   x^T G x / 2 - h^T x + pair_weight / 2 * sum over pairs of (x_a - x_b)^2
/// over lower <= x <= upper, with at most one unknown of each exclusive group away from its value
/// `off`. The unknowns may be a model's weights or the weights of each of its regions.
///
/// Pairs enter the matrix. Branch and bound finds the best choice in exclusive groups. A branch
/// ends if its solution without the open groups is no better than the best choice so far. Both are
/// exact, to rounding. Queries are const.
///
/// [Land, Doig. An automatic method of solving discrete programming problems. Econometrica 28(3),
/// 1960]
class RuledLeastSquares {
 public:
  /// `gram` D x D, symmetric positive semidefinite. Throws std::invalid_argument if sizes disagree,
  /// an unknown's index is out of range or bounds cross. Throws it also if `off` of an unknown in a
  /// group is outside its bounds.
  RuledLeastSquares(Eigen::MatrixXd gram, UnknownRules rules);

  /// Solution x for `h` (D). `start` (D, or empty) changes the time only. If the energies of
  /// choices agree to 1e-12, the lower unknown in the earlier group wins. Throws as
  /// box_least_squares().
  Eigen::VectorXd operator()(const Eigen::VectorXd& h, const Eigen::VectorXd& start = {}) const;

  /// Solves for all rows of `h` (F x D) together, with the penalty mu |D2 x|^2 / 2 of second
  /// differences over `times` (smooth_weights()). `single` (F x D) are the solutions of each row
  /// alone. They choose the unknown of each group that may move in each frame. If none moves in a
  /// frame, the choice of the frame before holds, or of the first frame with a choice. Throws as
  /// smooth_weights().
  Eigen::MatrixXd smooth(const Eigen::MatrixXd& h, const Eigen::VectorXd& times, double mu,
                         const Eigen::MatrixXd& single) const;

  /// G including the pairs' terms.
  const Eigen::MatrixXd& system() const { return system_; }
  const UnknownRules& rules() const { return rules_; }

 private:
  Eigen::MatrixXd system_;
  UnknownRules rules_;
};

}  // namespace mimetra
