#include "toolkit/splocs/weights.h"

namespace mimetra {
namespace {

// |C_k|^2 up to which a component counts as zero, for the scaled X: the value
// of the reference implementation.
constexpr double kNoEnergy = 1e-8;

}  // namespace

Eigen::VectorXd feasible_weights(const Eigen::VectorXd& weights, bool nonnegative) {
  const Eigen::VectorXd allowed = nonnegative ? Eigen::VectorXd(weights.cwiseMax(0)) : weights;
  const double largest = allowed.lpNorm<Eigen::Infinity>();
  return largest > 0 ? Eigen::VectorXd(allowed / largest) : allowed;
}

Eigen::MatrixXd updated_weights(Eigen::MatrixXd W, const Eigen::MatrixXd& P,
                                const Eigen::MatrixXd& H, bool nonnegative) {
  for (Eigen::Index k = 0; k < W.cols(); ++k) {
    if (H(k, k) <= kNoEnergy) {
      W.col(k).setZero();
      continue;
    }
    // The residual without component k, times C_k, is P_k - W H_k + w_k H_kk.
    const Eigen::VectorXd optimum = W.col(k) + (P.col(k) - W * H.col(k)) / H(k, k);
    W.col(k) = feasible_weights(optimum, nonnegative);
  }
  return W;
}

}  // namespace mimetra
