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

}  // namespace mimetra
