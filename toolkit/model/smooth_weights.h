#pragma once

#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// Bounds of weights over time, F x D each, lower <= upper; where they are equal the weight is
/// given. Empty for 0 and 1.
struct WeightBounds {
  Eigen::MatrixXd lower = {}, upper = {};
};

/// Minimises sum_f (beta_f^T G_f beta_f - 2 h_f^T beta_f) + mu |D2 beta|^2 with the second
/// differences D2 within `bounds`: an interior-point method on the banded system, polished on its
/// active set.
///
/// `grams`: D x D, one for all frames or one for each; `h` F x D; `times` F, ascending; `single` (F
/// x D), the solution without the penalty, is returned where there are fewer than three frames.
/// Throws std::invalid_argument where the number of Gram matrices is neither 1 nor F, or other
/// sizes disagree, std::runtime_error where it does not converge.
///
/// [Mehrotra. On the implementation of a primal-dual interior point method. SIAM J. Optimization 2,
/// 1992]
Eigen::MatrixXd smooth_weights(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h,
                               const Eigen::VectorXd& times, double mu,
                               const Eigen::MatrixXd& single, const WeightBounds& bounds = {});

/// Largest violation of the optimality conditions of that problem by `beta` (F x D): of the bounds,
/// and of the multipliers relative to |h|_inf (or 1 where h = 0). The exact minimum, rounded to
/// double, has up to 4 epsilon mu / |h|_inf at even times, by its own rounding. \pre F >= 3, and
/// sizes as there
double smooth_optimality_violation(const std::vector<Eigen::MatrixXd>& grams,
                                   const Eigen::MatrixXd& h, const Eigen::VectorXd& times,
                                   double mu, const Eigen::MatrixXd& beta,
                                   const WeightBounds& bounds = {});

}  // namespace mimetra
