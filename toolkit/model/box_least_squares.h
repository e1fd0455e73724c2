#pragma once

#include <Eigen/Core>

namespace mimetra {

/// Minimises x^T G x / 2 - h^T x over lower <= x <= upper for a symmetric positive semidefinite
/// `gram` (D x D), exactly (to rounding), by an active-set method. `start` (D, or empty) is clamped
/// into the box; where the solution is unique it changes the time only. Ties go to the lower index.
/// Throws std::invalid_argument where sizes disagree or bounds cross, std::runtime_error where the
/// system is not finite or not semidefinite.
///
/// [Stark, Parker. Bounded-Variable Least-Squares. Computational Statistics 10, 1995]
Eigen::VectorXd box_least_squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const Eigen::VectorXd& start = {});

/// Largest violation of the optimality conditions: of the bounds, and of the multipliers relative
/// to |h|_inf (or 1 where h = 0). 0 at the solution.
double box_optimality_violation(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const Eigen::VectorXd& x);

/// box_least_squares() of many unknowns: minimises x^T G x / 2 - h^T x over lower <= x <= upper for
/// a symmetric positive definite `gram` (D x D), exactly (to rounding).
///
/// A pass solves for the free unknowns and exchanges all that are on the wrong side of a bound or
/// of a multiplier at once, so that the passes are few however many unknowns change sides; where
/// that does not end, box_least_squares() goes on from there. `start` (D, or empty) is clamped into
/// the box: unknowns inside begin free. Throws as box_least_squares().
///
/// [Portugal, Judice, Vicente. A comparison of block pivoting and interior-point algorithms for
/// linear least squares problems with nonnegative variables. Math. Comp. 63, 1994]
Eigen::VectorXd block_pivoting(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                               const Eigen::VectorXd& start = {});

}  // namespace mimetra
