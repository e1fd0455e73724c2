#pragma once

#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// Bounds of weights over time, F x D each, lower <= upper; equal bounds fix the weight. Empty
/// means 0 and 1.
struct WeightBounds {
  Eigen::MatrixXd lower = {}, upper = {};
};

/// Minimises sum_f (beta_f^T G_f beta_f - 2 h_f^T beta_f) + mu |D2 beta|^2 within `bounds`, where
/// D2 are the second differences over time. An interior-point method solves the banded system; its
/// active set polishes the result.
///
/// `grams`: D x D, one for all frames or one for each; `h` F x D; `times` F, ascending. `single`
/// (F x D) is the solution without the penalty, which is returned if there are fewer than three
/// frames. Throws std::invalid_argument if there are neither 1 nor F Gram matrices, other sizes
/// disagree or bounds cross. Throws std::runtime_error if the method does not converge.
///
/// [Mehrotra. On the implementation of a primal-dual interior point method. SIAM J. Optimization 2,
/// 1992]
Eigen::MatrixXd smooth_weights(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h,
                               const Eigen::VectorXd& times, double mu,
                               const Eigen::MatrixXd& single, const WeightBounds& bounds = {});

/// Largest violation of the optimality conditions of smooth_weights() by `beta` (F x D). Violations
/// of bounds are absolute; violations of multipliers are relative to |h|_inf (or to 1 if h = 0).
/// Rounding the exact minimum to double alone gives up to 4 epsilon mu / |h|_inf at even times.
/// \pre F >= 3, and sizes as in smooth_weights()
double smooth_optimality_violation(const std::vector<Eigen::MatrixXd>& grams,
                                   const Eigen::MatrixXd& h, const Eigen::VectorXd& times,
                                   double mu, const Eigen::MatrixXd& beta,
                                   const WeightBounds& bounds = {});

}  // namespace mimetra
