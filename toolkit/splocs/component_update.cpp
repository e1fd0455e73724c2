#include <mimetra/splocs/component_update.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <mimetra/mesh/parallel.h>

namespace mimetra {
namespace {

// Vertices in a block: its columns of X, C, Z and U fit into a core's cache for a few hundred
// frames, and its products are still wide enough to be fast. Fixed, so that sums round the same
// everywhere.
constexpr Eigen::Index kBlockVertices = 64;
// Blocks that one thread takes together, with sums of their own.
constexpr Eigen::Index kRangeVertices = 8 * kBlockVertices;

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

/// What a range of vertices adds to a ComponentUpdate's sums.
struct Sums {
  Eigen::MatrixXd P, H;
  double penalty = 0;

  Sums(Eigen::Index frames, Eigen::Index K)
      : P(Eigen::MatrixXd::Zero(frames, K)), H(Eigen::MatrixXd::Zero(K, K)) {}

  void add(const Eigen::Ref<const Frames>& X, const Frames& C) {
    P.noalias() += X * C.transpose();
    H.noalias() += C * C.transpose();
  }
};

/// All ADMM steps on the vertices first .. last - 1 of `update`, which writes to no others.
Sums update_range(ComponentUpdate& update, const Frames& X, const Eigen::MatrixXd& support,
                  const StepMatrices& step, const AdmmOptions& options, Eigen::Index begin,
                  Eigen::Index end) {
  Sums sums(X.rows(), update.C.rows());
  for (Eigen::Index first = begin; first < end; first += kBlockVertices) {
    const Eigen::Index count = std::min(kBlockVertices, end - first);
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
    sums.add(X_block, splitting.Z);
    sums.penalty += options.sparsity * penalty(splitting.Z, support_block);
  }
  return sums;
}

}  // namespace

ComponentUpdate initial_components(const Frames& X, Frames components) {
  ComponentUpdate initial;
  initial.C = std::move(components);
  initial.U = Frames::Zero(initial.C.rows(), initial.C.cols());
  initial.P = X * initial.C.transpose();
  initial.H = initial.C * initial.C.transpose();
  return initial;
}

ComponentUpdate updated_components(const Frames& X, const Eigen::MatrixXd& W,
                                   const Eigen::MatrixXd& support, ComponentUpdate last,
                                   const AdmmOptions& options) {
  const StepMatrices step = step_matrices(W, options.rho);
  ComponentUpdate update = std::move(last);
  const Eigen::Index vertices = support.cols();
  const auto ranges = static_cast<int>((vertices + kRangeVertices - 1) / kRangeVertices);
  std::vector<Sums> sums(static_cast<std::size_t>(ranges), Sums(0, 0));
  parallel_for(ranges, options.threads, [&](int range) {
    const Eigen::Index begin = range * kRangeVertices;
    const Eigen::Index end = std::min(begin + kRangeVertices, vertices);
    sums[static_cast<std::size_t>(range)] =
        update_range(update, X, support, step, options, begin, end);
  });
  update.P = Eigen::MatrixXd::Zero(X.rows(), update.C.rows());
  update.H = Eigen::MatrixXd::Zero(update.C.rows(), update.C.rows());
  update.penalty = 0;
  for (const Sums& part : sums) {
    update.P += part.P;
    update.H += part.H;
    update.penalty += part.penalty;
  }
  return update;
}

}  // namespace mimetra
