#include <mimetra/splocs/component_update.h>

#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include <mimetra/mesh/parallel.h>

namespace mimetra {
namespace {

template <typename Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// The constant part of an ADMM step: C = (W^T W + rho I)^-1 (W^T X + rho (Z - U)).
template <typename Scalar>
struct StepMatrices {
  Matrix<Scalar> of_data;       ///< (W^T W + rho I)^-1 W^T, K x R
  Matrix<Scalar> of_splitting;  ///< rho (W^T W + rho I)^-1, K x K

  StepMatrices(const UpdateWeights& W, double rho) {
    Eigen::MatrixXd system = W.gram;
    system.diagonal().array() += rho;
    // Safe to invert: every eigenvalue is at least rho, and W has entries of at most 1.
    const Eigen::LLT<Eigen::MatrixXd> factor(system);
    const auto K = system.rows();
    of_data = factor.solve(W.rows.transpose()).template cast<Scalar>();
    of_splitting = (rho * factor.solve(Eigen::MatrixXd::Identity(K, K))).template cast<Scalar>();
  }
};

/// Lengths of a row's n displacement vectors.
template <typename Row>
auto lengths(const Row& row, Eigen::Index n) {
  return (row.segment(0, n).square() + row.segment(n, n).square() + row.segment(2 * n, n).square())
      .sqrt();
}

/// Z = prox(V), each vertex's vector shortened by its threshold (K x n), and U = V - Z.
template <typename Block>
void shrink(const Block& V, const Block& thresholds, Block& Z, Block& U) {
  using Scalar = typename Block::Scalar;
  // Longer than this, or nothing of it is kept; it keeps 0 / 0 away.
  constexpr Scalar kShortest = std::numeric_limits<Scalar>::min();
  const Eigen::Index n = thresholds.cols();
  Eigen::Array<Scalar, 1, Eigen::Dynamic> kept(n);
  for (Eigen::Index k = 0; k < V.rows(); ++k) {
    const auto v = V.row(k).array();
    kept = (1 - thresholds.row(k).array() / lengths(v, n).max(kShortest)).max(Scalar(0));
    for (const Eigen::Index axis : {Eigen::Index(0), n, 2 * n}) {
      Z.row(k).segment(axis, n).array() = kept * v.segment(axis, n);
    }
  }
  U = V - Z;
}

/// What a block adds to a ComponentUpdate's sums.
template <typename Scalar>
struct Sums {
  Matrix<Scalar> P, H;
  double penalty = 0;
};

template <typename Block>
Sums<typename Block::Scalar> products(const Block& X, const Block& C) {
  return {X * C.transpose(), C * C.transpose()};
}

/// Calls `work` for all blocks and adds up what it returns, in their order.
template <typename Scalar>
void sum_over_blocks(ComponentUpdate<Scalar>& update, const VertexBlocks<Scalar>& X, int threads,
                     const std::function<Sums<Scalar>(int)>& work) {
  std::vector<Sums<Scalar>> parts(X.count());
  parallel_for(X.count(), threads, [&](int b) { parts[b] = work(b); });
  const Eigen::Index K = update.C.rows();
  update.P = Eigen::MatrixXd::Zero(X.rows(), K);
  update.H = Eigen::MatrixXd::Zero(K, K);
  update.penalty = 0;
  for (const Sums<Scalar>& part : parts) {
    update.P += part.P.template cast<double>();
    update.H += part.H.template cast<double>();
    update.penalty += part.penalty;
  }
}

/// All ADMM steps on one block of components `C` and their dual variable `U` (K x 3n).
template <typename Scalar, typename Block>
void run_admm(const Block& X, const StepMatrices<Scalar>& step, const Block& thresholds, int steps,
              Block& C, Block& U) {
  const Block of_data = step.of_data * X;
  Block difference, V;
  for (int s = 0; s < steps; ++s) {
    difference = C - U;
    V = of_data + U;
    V.noalias() += step.of_splitting * difference;
    // The components are Z in the end: only Z has exact zeros.
    shrink(V, thresholds, C, U);
  }
}

}  // namespace

template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const VertexBlocks<Scalar>& X,
                                           VertexBlocks<Scalar> components, int threads) {
  ComponentUpdate<Scalar> initial;
  initial.C = std::move(components);
  initial.U = VertexBlocks<Scalar>(initial.C.rows(), initial.C.vertices());
  sum_over_blocks<Scalar>(initial, X, threads, [&](int b) {
    initial.U[b] = initial.U.zero_block(b);
    return products(X[b], initial.C[b]);
  });
  return initial;
}

template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const VertexBlocks<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options) {
  using Block = typename VertexBlocks<Scalar>::Block;
  const StepMatrices<Scalar> step(W, options.rho);
  ComponentUpdate<Scalar> update = std::move(last);
  sum_over_blocks<Scalar>(update, X, options.threads, [&](int b) {
    const Eigen::Index n = X.size(b);
    const Block Lambda =
        (options.sparsity * support.middleCols(X.first(b), n)).template cast<Scalar>();
    Block& C = update.C[b];
    run_admm<Scalar, Block>(X[b], step, Lambda / Scalar(options.rho), options.steps, C,
                            update.U[b]);
    Sums<Scalar> sums = products(X[b], C);
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      sums.penalty += (Lambda.row(k).array() * lengths(C.row(k).array(), n)).sum();
    }
    return sums;
  });
  return update;
}

template ComponentUpdate<double> initial_components(const VertexBlocks<double>&,
                                                    VertexBlocks<double>, int);
template ComponentUpdate<float> initial_components(const VertexBlocks<float>&, VertexBlocks<float>,
                                                   int);
template ComponentUpdate<double> updated_components(const VertexBlocks<double>&,
                                                    const UpdateWeights&, const Frames&,
                                                    ComponentUpdate<double>, const AdmmOptions&);
template ComponentUpdate<float> updated_components(const VertexBlocks<float>&, const UpdateWeights&,
                                                   const Frames&, ComponentUpdate<float>,
                                                   const AdmmOptions&);

}  // namespace mimetra
