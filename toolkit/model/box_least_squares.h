#pragma once

#include <Eigen/Core>

namespace mimetra {

/// Minimises x^T G x / 2 - h^T x over lower <= x <= upper by an active-set method, exactly (to
/// rounding). `gram` G is symmetric positive semidefinite (D x D). `start` (D, or empty) is clamped
/// into the box; if the solution is unique, it changes the time only. Ties go to the lower index.
/// Throws std::invalid_argument if sizes disagree or bounds cross, and std::runtime_error if the
/// system is not finite or not semidefinite.
///
/// [Stark, Parker. Bounded-Variable Least-Squares. Computational Statistics 10, 1995]
Eigen::VectorXd box_least_squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const Eigen::VectorXd& start = {});

/// Largest violation of the optimality conditions, 0 at the solution. Violations of bounds are
/// absolute; violations of multipliers are relative to |h|_inf (or to 1 if h = 0).
double box_optimality_violation(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const Eigen::VectorXd& x);

/// Solves box_least_squares() for many unknowns, exactly (to rounding). `gram` must be symmetric
/// positive definite (D x D).
///
/// Each pass solves for the free unknowns, then exchanges all unknowns on the wrong side of a bound
/// or multiplier at once. So the number of passes stays small however many unknowns change sides.
/// If the passes do not end, box_least_squares() continues from there. `start` (D, or empty) is
/// clamped into the box; unknowns strictly inside begin free. Throws as box_least_squares().
///
/// [Portugal, Judice, Vicente. A comparison of block pivoting and interior-point algorithms for
/// linear least squares problems with nonnegative variables. Math. Comp. 63, 1994]
Eigen::VectorXd block_pivoting(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                               const Eigen::VectorXd& start = {});

}  // namespace mimetra
