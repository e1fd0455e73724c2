#include <mimetra/splocs/component_update.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace mimetra {
namespace {

// Vertices in a block: its columns of X, C, Z and U fit into a core's cache for a few hundred
// frames, and its products are still wide enough to be fast. Fixed, so that sums round the same
// everywhere.
constexpr Eigen::Index kBlockVertices = 64;

/// The constant part of an ADMM step: C = (W^T W + rho I)^-1 (W^T X + rho (Z - U)).
struct StepMatrices {
  Eigen::MatrixXd of_data;       ///< (W^T W + rho I)^-1 W^T, K x F
  Eigen::MatrixXd of_splitting;  ///< rho (W^T W + rho I)^-1, K x K
};

StepMatrices step_matrices(const Eigen::MatrixXd& W, double rho) {
  const Eigen::Index K = W.cols();
  Eigen::MatrixXd system = W.transpose() * W;
  system.diagonal().array() += rho;
  // Safe to invert: every eigenvalue is at least rho, and W has entries of at most 1.
  const Eigen::LLT<Eigen::MatrixXd> factor(system);
  return {factor.solve(W.transpose()), rho * factor.solve(Eigen::MatrixXd::Identity(K, K))};
}

/// The two variables that ADMM adds, on one block of vertices (K x 3n).
struct Splitting {
  Frames Z, U;

  /// Z = prox(V), each vertex's vector shortened by its threshold (K x n), and U = V - Z.
  void shrink(const Frames& V, const Eigen::Ref<const Eigen::MatrixXd>& thresholds) {
    for (Eigen::Index k = 0; k < V.rows(); ++k) {
      for (Eigen::Index i = 0; i < thresholds.cols(); ++i) {
        const auto v = V.row(k).segment<3>(3 * i);
        const double threshold = thresholds(k, i), length2 = v.squaredNorm();
        double kept = 1;
        if (threshold > 0) {
          kept = length2 > threshold * threshold ? 1 - threshold / std::sqrt(length2) : 0;
        }
        Z.row(k).segment<3>(3 * i) = kept * v;
        U.row(k).segment<3>(3 * i) = v - kept * v;
      }
    }
  }
};

double penalty(const Frames& C, const Eigen::Ref<const Eigen::MatrixXd>& support) {
  double sum = 0;
  for (Eigen::Index k = 0; k < C.rows(); ++k) {
    for (Eigen::Index i = 0; i < support.cols(); ++i) {
      sum += support(k, i) * C.row(k).segment<3>(3 * i).norm();
    }
  }
  return sum;
}

void add_products(ComponentUpdate& update, const Eigen::Ref<const Frames>& X, const Frames& C) {
  update.P.noalias() += X * C.transpose();
  update.H.noalias() += C * C.transpose();
}

void reset_products(ComponentUpdate& update, Eigen::Index frames) {
  const Eigen::Index K = update.C.rows();
  update.P = Eigen::MatrixXd::Zero(frames, K);
  update.H = Eigen::MatrixXd::Zero(K, K);
  update.penalty = 0;
}

}  // namespace

ComponentUpdate initial_components(const Frames& X, Frames components) {
  ComponentUpdate initial;
  initial.C = std::move(components);
  initial.U = Frames::Zero(initial.C.rows(), initial.C.cols());
  reset_products(initial, X.rows());
  add_products(initial, X, initial.C);
  return initial;
}

ComponentUpdate updated_components(const Frames& X, const Eigen::MatrixXd& W,
                                   const Eigen::MatrixXd& support, ComponentUpdate last,
                                   const AdmmOptions& options) {
  const StepMatrices step = step_matrices(W, options.rho);
  ComponentUpdate update = std::move(last);
  reset_products(update, X.rows());
  for (Eigen::Index first = 0; first < support.cols(); first += kBlockVertices) {
    const Eigen::Index count = std::min(kBlockVertices, support.cols() - first);
    const auto X_block = X.middleCols(3 * first, 3 * count);
    const auto support_block = support.middleCols(first, count);
    const Eigen::MatrixXd thresholds = options.sparsity / options.rho * support_block;
    const Frames of_data = step.of_data * X_block;
    Splitting splitting{update.C.middleCols(3 * first, 3 * count),
                        update.U.middleCols(3 * first, 3 * count)};
    Frames difference, V;
    for (int s = 0; s < options.steps; ++s) {
      difference = splitting.Z - splitting.U;
      V = of_data + splitting.U;
      V.noalias() += step.of_splitting * difference;
      splitting.shrink(V, thresholds);
    }
    // C = Z in the end: only Z has exact zeros.
    update.C.middleCols(3 * first, 3 * count) = splitting.Z;
    update.U.middleCols(3 * first, 3 * count) = splitting.U;
    add_products(update, X_block, splitting.Z);
    update.penalty += options.sparsity * penalty(splitting.Z, support_block);
  }
  return update;
}

}  // namespace mimetra
