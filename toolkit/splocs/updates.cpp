#include "toolkit/splocs/updates.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "geodesic/support_map.h"

namespace mimetra {
namespace {

// |C_k|^2 up to which a component counts as zero, for the scaled X: the value of the reference
// implementation.
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

SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max) {
  return [distances = std::move(distances), vertices, d_min,
          d_max](std::span<const VertexIndex> centers) {
    Eigen::MatrixXd maps = distances(centers);
    if (maps.rows() != vertices || maps.cols() != static_cast<Eigen::Index>(centers.size())) {
      throw std::invalid_argument(
          "distances from " + std::to_string(centers.size()) + " of " + std::to_string(vertices) +
          " vertices: " + std::to_string(maps.rows()) + " x " + std::to_string(maps.cols()) +
          " values, expected one row a vertex and one column a source");
    }
    for (auto map : maps.colwise()) map = geodesic::support_map(map, d_min, d_max);
    return maps;
  };
}

SupportMaps::SupportMaps(SupportFunction support, int components, const VertexPart& part,
                         Eigen::VectorXd center_weights)
    : support_(std::move(support)),
      center_weights_(std::move(center_weights)),
      centers_(components, -1),
      maps_(Frames::Ones(components, part.vertices())) {}

template <typename Scalar>
void SupportMaps::follow(const VertexBlocks<Scalar>& components, const Reduction& reduction) {
  const VertexPart& part = reduction.part();
  const auto weighted_energies = [&](int b) {
    Eigen::MatrixXd energies(components.rows(), components.size(b));
    for (Eigen::Index k = 0; k < components.rows(); ++k) {
      energies.row(k) = components.by_vertex(components[b], k)
                            .rowwise()
                            .squaredNorm()
                            .transpose()
                            .template cast<double>();
    }
    if (center_weights_.size() > 0) {
      const auto weights =
          center_weights_.segment(part.first() + components.first(b), components.size(b));
      energies *= weights.asDiagonal();
    }
    return energies;
  };
  const std::vector<VertexIndex> centers =
      reduction.argmax(static_cast<int>(components.rows()), weighted_energies);
  std::vector<Eigen::Index> moved;
  std::vector<VertexIndex> moved_to;
  for (std::size_t k = 0; k < centers.size(); ++k) {
    if (centers[k] < 0 || centers[k] == centers_[k]) continue;
    centers_[k] = centers[k];
    moved.push_back(static_cast<Eigen::Index>(k));
    moved_to.push_back(centers[k]);
  }
  if (moved.empty()) return;
  const Eigen::MatrixXd maps = support_(moved_to);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    maps_.row(moved[i]) =
        maps.col(static_cast<Eigen::Index>(i)).segment(part.first(), part.vertices());
  }
}

template void SupportMaps::follow(const VertexBlocks<double>&, const Reduction&);
template void SupportMaps::follow(const VertexBlocks<float>&, const Reduction&);

namespace {

template <typename Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Constant matrices of an ADMM step: C = (W^T W + rho I)^-1 (W^T X + rho (Z - U)).
template <typename Scalar>
struct StepMatrices {
  Matrix<Scalar> of_data;       ///< (W^T W + rho I)^-1 W^T, K x R
  Matrix<Scalar> of_splitting;  ///< rho (W^T W + rho I)^-1, K x K

  /// Splits both matrices, given side by side.
  explicit StepMatrices(const Eigen::MatrixXd& both)
      : of_data(both.leftCols(both.cols() - both.rows()).template cast<Scalar>()),
        of_splitting(both.rightCols(both.rows()).template cast<Scalar>()) {}
};

/// Both matrices of a step, K x (R + K).
Eigen::MatrixXd step_matrices(const UpdateWeights& W, double rho) {
  Eigen::MatrixXd system = W.gram;
  system.diagonal().array() += rho;
  // Safe to invert: every eigenvalue is at least rho, and W has entries of at most 1.
  const Eigen::LLT<Eigen::MatrixXd> factor(system);
  const Eigen::Index K = system.rows(), R = W.rows.rows();
  Eigen::MatrixXd both(K, R + K);
  both.leftCols(R) = factor.solve(W.rows.transpose());
  both.rightCols(K) = rho * factor.solve(Eigen::MatrixXd::Identity(K, K));
  return both;
}

/// Lengths of a row's n displacement vectors.
template <typename Row>
auto lengths(const Row& row, Eigen::Index n) {
  return (row.segment(0, n).square() + row.segment(n, n).square() + row.segment(2 * n, n).square())
      .sqrt();
}

/// Runs all ADMM steps on one block of components and dual variables while it is in cache.
template <typename Scalar>
class BlockAdmm {
 public:
  using Block = typename VertexBlocks<Scalar>::Block;

  /// `X` R x 3n, `thresholds` K x n.
  BlockAdmm(const Block& X, const StepMatrices<Scalar>& step, const Block& thresholds)
      : step_(step), thresholds_(thresholds), of_data_(step.of_data * X) {}

  /// Moves components `C` and dual variable `U` (K x 3n) by `steps` steps.
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

  /// Computes the share of each vertex's vector that remains after thresholding.
  void shrink(Eigen::Index k) {
    // Avoids 0 / 0 for vectors of length 0.
    constexpr Scalar kShortest = std::numeric_limits<Scalar>::min();
    const auto v = V_.row(k).array();
    kept_ = (1 - thresholds_.row(k).array() / lengths(v, vertices()).max(kShortest)).max(Scalar(0));
  }

  /// Computes only what the next step needs of Z = kept V and U = V - Z: the difference Z - U, and
  /// data + U.
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

  /// The final components are Z, because only Z has exact zeros.
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

/// Contributions of a run's blocks to the sums of a ComponentUpdate, in the precision of the
/// blocks.
template <typename Scalar>
class RunSums {
 public:
  /// Zero sums for R rows of X and K components.
  RunSums(Eigen::Index R, Eigen::Index K)
      : P_(Matrix<Scalar>::Zero(R, K)),
        H_(Matrix<Scalar>::Zero(K, K)),
        penalties_(Eigen::RowVectorXd::Zero(K)) {}

  template <typename Block>
  void add_products(const Block& X, const Block& C) {
    P_.noalias() += X * C.transpose();
    H_.noalias() += C * C.transpose();
  }
  void add_penalty(Eigen::Index k, double penalty) { penalties_[k] += penalty; }

  /// P above H above the penalty of each component, (R + K + 1) x K.
  void write(Eigen::MatrixXd& sums) const {
    sums << P_.template cast<double>(), H_.template cast<double>(), penalties_;
  }

 private:
  Matrix<Scalar> P_, H_;
  Eigen::RowVectorXd penalties_;
};

/// Calls `work` for all blocks and adds up their contributions.
template <typename Scalar, typename Work>
void sum_over_blocks(ComponentUpdate<Scalar>& update, Eigen::Index R, const Reduction& reduction,
                     const Work& work) {
  const Eigen::Index K = update.C.rows();
  const Eigen::MatrixXd sums = reduction.sum(R + K + 1, K, [&](int run, Eigen::MatrixXd& of_run) {
    RunSums<Scalar> sums_of_run(R, K);
    const IndexRange blocks = reduction.part().blocks_of(run);
    for (int b = blocks.first; b < blocks.end; ++b) work(b, sums_of_run);
    sums_of_run.write(of_run);
  });
  if (!reduction.is_first()) return;
  update.P = sums.topRows(R);
  update.H = sums.middleRows(R, K);
  update.penalty = sums.row(R + K).sum();
}

}  // namespace

template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const BlockSource<Scalar>& X,
                                           VertexBlocks<Scalar> components,
                                           const Reduction& reduction) {
  ComponentUpdate<Scalar> initial;
  initial.C = std::move(components);
  initial.U = VertexBlocks<Scalar>(initial.C.rows(), X.part());
  sum_over_blocks(initial, X.rows(), reduction, [&](int b, RunSums<Scalar>& sums) {
    initial.U[b] = initial.U.zero_block(b);
    sums.add_products(*X.block(b), initial.C[b]);
  });
  return initial;
}

template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const BlockSource<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options, const Reduction& reduction) {
  using Block = typename VertexBlocks<Scalar>::Block;
  const StepMatrices<Scalar> step(
      reduction.on_first([&] { return step_matrices(W, options.rho); }));
  ComponentUpdate<Scalar> update = std::move(last);
  sum_over_blocks(update, X.rows(), reduction, [&](int b, RunSums<Scalar>& sums) {
    const Eigen::Index n = X.size(b);
    const Block Lambda =
        (options.sparsity * support.middleCols(X.first(b), n)).template cast<Scalar>();
    const Block thresholds = Lambda / Scalar(options.rho);
    const auto of_block = X.block(b);
    Block& C = update.C[b];
    BlockAdmm<Scalar>(*of_block, step, thresholds).run(options.steps, C, update.U[b]);
    sums.add_products(*of_block, C);
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      sums.add_penalty(k, (Lambda.row(k).array() * lengths(C.row(k).array(), n)).sum());
    }
  });
  return update;
}

template ComponentUpdate<double> initial_components(const BlockSource<double>&,
                                                    VertexBlocks<double>, const Reduction&);
template ComponentUpdate<float> initial_components(const BlockSource<float>&, VertexBlocks<float>,
                                                   const Reduction&);
template ComponentUpdate<double> updated_components(const BlockSource<double>&,
                                                    const UpdateWeights&, const Frames&,
                                                    ComponentUpdate<double>, const AdmmOptions&,
                                                    const Reduction&);
template ComponentUpdate<float> updated_components(const BlockSource<float>&, const UpdateWeights&,
                                                   const Frames&, ComponentUpdate<float>,
                                                   const AdmmOptions&, const Reduction&);

}  // namespace mimetra
