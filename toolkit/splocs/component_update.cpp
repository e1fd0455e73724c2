#include "toolkit/splocs/component_update.h"

#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "toolkit/splocs/block_sums.h"

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

/// All ADMM steps on one block of components and their dual variable, in its cache.
template <typename Scalar>
class BlockAdmm {
 public:
  using Block = typename VertexBlocks<Scalar>::Block;

  /// `X` R x 3n, `thresholds` K x n.
  BlockAdmm(const Block& X, const StepMatrices<Scalar>& step, const Block& thresholds)
      : step_(step), thresholds_(thresholds), of_data_(step.of_data * X) {}

  /// Moves components `C` and dual variable `U` (K x 3n) by so many steps.
  void run(int steps, Block& C, Block& U) {
    difference_ = C - U;
    V_ = of_data_ + U;
    for (int s = 0; s < steps; ++s) {
      V_.noalias() += step_.of_splitting * difference_;
      for (Eigen::Index k = 0; k < V_.rows(); ++k) {
        if (s + 1 < steps) {
          prepare_next(k);
        } else {
          finish(k, C, U);
        }
      }
    }
  }

 private:
  using Row = Eigen::Array<Scalar, 1, Eigen::Dynamic>;

  /// Share of each vertex's vector that its threshold leaves.
  void shrink(Eigen::Index k) {
    // Longer than this, or nothing of it is kept; it keeps 0 / 0 away.
    constexpr Scalar kShortest = std::numeric_limits<Scalar>::min();
    const auto v = V_.row(k).array();
    kept_ = (1 - thresholds_.row(k).array() / lengths(v, vertices()).max(kShortest)).max(Scalar(0));
  }

  /// Of Z = kept V and U = V - Z only what the next step needs: Z - U, and the data and U.
  void prepare_next(Eigen::Index k) {
    shrink(k);
    for (int axis = 0; axis < 3; ++axis) {
      const auto part = [&](Block& block) {
        return block.row(k).segment(axis * vertices(), vertices()).array();
      };
      part(difference_) = (2 * kept_ - 1) * part(V_);
      part(V_) = part(of_data_) + (1 - kept_) * part(V_);
    }
  }

  /// The components are Z in the end: only Z has exact zeros.
  void finish(Eigen::Index k, Block& C, Block& U) {
    shrink(k);
    C.row(k).array() = kept_.replicate(1, 3) * V_.row(k).array();
    U.row(k) = V_.row(k) - C.row(k);
  }

  Eigen::Index vertices() const { return thresholds_.cols(); }

  const StepMatrices<Scalar>& step_;
  const Block& thresholds_;
  Block of_data_, difference_, V_;
  Row kept_;
};

/// What blocks add to a ComponentUpdate's sums.
template <typename Scalar>
struct Sums {
  Matrix<Scalar> P, H;
  double penalty = 0;

  template <typename Block>
  void add(const Block& X, const Block& C) {
    if (P.size() == 0) {
      P.setZero(X.rows(), C.rows());
      H.setZero(C.rows(), C.rows());
    }
    P.noalias() += X * C.transpose();
    H.noalias() += C * C.transpose();
  }
};

/// Calls `work` for all blocks, and adds up what they give to the sums.
template <typename Scalar>
void sum_over_blocks(ComponentUpdate<Scalar>& update, const VertexBlocks<Scalar>& X, int threads,
                     const std::function<void(int, Sums<Scalar>&)>& work) {
  const auto parts = sums_over_runs<Sums<Scalar>>(X.count(), threads, work);
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

}  // namespace

template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const VertexBlocks<Scalar>& X,
                                           VertexBlocks<Scalar> components, int threads) {
  ComponentUpdate<Scalar> initial;
  initial.C = std::move(components);
  initial.U = VertexBlocks<Scalar>(initial.C.rows(), initial.C.vertices());
  sum_over_blocks<Scalar>(initial, X, threads, [&](int b, Sums<Scalar>& sums) {
    initial.U[b] = initial.U.zero_block(b);
    sums.add(X[b], initial.C[b]);
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
  sum_over_blocks<Scalar>(update, X, options.threads, [&](int b, Sums<Scalar>& sums) {
    const Eigen::Index n = X.size(b);
    const Block Lambda =
        (options.sparsity * support.middleCols(X.first(b), n)).template cast<Scalar>();
    const Block thresholds = Lambda / Scalar(options.rho);
    Block& C = update.C[b];
    BlockAdmm<Scalar>(X[b], step, thresholds).run(options.steps, C, update.U[b]);
    sums.add(X[b], C);
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      sums.penalty += (Lambda.row(k).array() * lengths(C.row(k).array(), n)).sum();
    }
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
