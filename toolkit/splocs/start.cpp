#include "toolkit/splocs/start.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

// Residual energy, relative to the vertex that moves most, that is only rounding of the
// subtractions: amplitudes of 1e-12.
constexpr double kNothingLeft = 1e-24;

// If the norms of both signs differ by less than this share, time decides, because rounding would
// decide otherwise.
constexpr double kSameNorm = 1e-9;

/// Sum over x, y and z for each vertex of a block (n), from its columns (3n).
Eigen::VectorXd sums_over_axes(const Eigen::RowVectorXd& columns) {
  return columns.reshaped(columns.size() / 3, 3).rowwise().sum();
}

/// Residual X - W C of the start, stored as X and the components so far, never as a matrix.
class Residual {
 public:
  Residual(const BlockSource<double>& X, const DecompositionOptions& options,
           const Reduction& reduction)
      : X_(X),
        start_{{}, {options.count, X.part()}, Eigen::MatrixXd::Zero(X.rows(), options.count)},
        energies_(X.vertices()),
        parts_(options.parts),
        reduction_(reduction) {
    if (!parts_.empty()) {
      center_weights_ = parts_.of_vertices().segment(X.part().first(), X.vertices());
    }
    const auto largest_energy = [this](int run, Eigen::MatrixXd& largest) {
      const IndexRange blocks = X_.part().blocks_of(run);
      for (int b = blocks.first; b < blocks.end; ++b) {
        start_.components[b] = start_.components.zero_block(b);
        largest(0) = std::max(largest(0), set_energies(b));
      }
    };
    nothing_left_ =
        kNothingLeft * reduction_.everywhere(reduction_.largest(1, 1, largest_energy))(0);
  }

  /// Vertex with the largest weighted residual energy, or -1 if nothing is left.
  VertexIndex strongest() {
    for (;;) {
      const VertexIndex v = strongest_vertex(energies_, center_weights_, reduction_);
      if (v < 0) return -1;
      const int owner = X_.part().owner(v);
      const Eigen::Vector2d energy = reduction_.on(
          owner, [&] { return Eigen::Vector2d(energies_[place(v)], at(v).squaredNorm()); });
      if (energy[0] <= nothing_left_) return -1;
      // Updates leave rounding in the energies, relative to the vertex's initial motion. Near the
      // end only the residual itself shows whether the energy is really the largest.
      if (energy[1] >= energy[0]) return v;
      if (owner == X_.part().rank()) energies_[place(v)] = energy[1];
    }
  }

  /// Residual of vertex v (F x 3). Components are subtracted one by one: X - W C at once rounds
  /// differently if they cancel, which the weights show. \pre the rank owns v
  Eigen::MatrixX3d at(VertexIndex v) const {
    Eigen::MatrixX3d residual = X_.vertex(v);
    const Eigen::MatrixX3d components = start_.components.vertex(v);
    for (int k = 0; k < size(); ++k) residual -= start_.weights.col(k) * components.row(k);
    return residual;
  }

  /// Adds the component that the weights `w` explain best. It is scaled by 1 - `support` (N) on the
  /// centre's part of the surface and by 1 - weight on others.
  void explain(VertexIndex center, const Eigen::VectorXd& w, Eigen::VectorXd support) {
    for (std::size_t v = 0; v < parts_.of_vertex.size(); ++v) {
      const int part = parts_.of_vertex[v];
      if (part != parts_.of_vertex[center]) support[v] = parts_.weights[part];
    }
    const int k = size();
    const double ww = w.squaredNorm();
    const Eigen::VectorXd overlap = start_.weights.leftCols(k).transpose() * w;
    const auto explain_block = [&](int b) {
      VertexBlocks<double>::Block& C = start_.components[b];
      Eigen::RowVectorXd wR = w.transpose() * *X_.block(b);
      wR.noalias() -= overlap.transpose() * C.topRows(k);
      const Eigen::ArrayXd share =
          1 - support.segment(X_.part().first() + X_.first(b), X_.size(b)).array();
      energies_.segment(X_.first(b), X_.size(b)).array() -=
          (2 * share - share.square()) * sums_over_axes(wR.array().square()).array() / ww;
      C.row(k) = wR.array() * share.transpose().replicate(1, 3) / ww;
    };
    parallel_for(X_.count(), explain_block, reduction_.context());
    start_.weights.col(k) = w;
    start_.centers.push_back(center);
  }

  Start start() && {
    start_.centers.resize(start_.weights.cols(), -1);
    return std::move(start_);
  }

 private:
  int size() const { return static_cast<int>(start_.centers.size()); }

  /// Index of vertex v among the rank's vertices.
  Eigen::Index place(VertexIndex v) const { return v - X_.part().first(); }

  /// Sets the energies of a block's vertices over all frames and returns the largest.
  double set_energies(int b) {
    const auto X = X_.block(b);
    Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(X->cols());
    for (const auto& frame : X->rowwise()) squares += frame.cwiseAbs2();
    auto energies = energies_.segment(X_.first(b), X_.size(b));
    energies = sums_over_axes(squares);
    return energies.maxCoeff();
  }

  const BlockSource<double>& X_;
  Start start_;
  Eigen::VectorXd energies_;  ///< energies of the rank's vertices (n)
  const PartWeights& parts_;
  Eigen::VectorXd center_weights_;  ///< weights of the rank's vertices, or empty
  const Reduction& reduction_;
  double nothing_left_ = 0;
};

/// First left singular vector of an F x 3 matrix times its singular value.
Eigen::VectorXd strongest_motion(const Eigen::MatrixX3d& residual) {
  const Eigen::Matrix3d gram = residual.transpose() * residual;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(gram);
  return residual * directions.eigenvectors().col(2);
}

bool prefers_negative(const Eigen::VectorXd& w) {
  const double positive = w.cwiseMax(0).norm(), negative = w.cwiseMin(0).norm();
  if (std::abs(positive - negative) > kSameNorm * std::max(positive, negative)) {
    return negative > positive;
  }
  const double half = w.lpNorm<Eigen::Infinity>() / 2;
  return *std::find_if(w.begin(), w.end(), [half](double x) { return std::abs(x) > half; }) < 0;
}

}  // namespace

Eigen::VectorXd oriented_weights(const Eigen::VectorXd& w, SignRule rule, bool nonnegative) {
  // Both signs of signed weights have the same norm: the literal rule cannot choose between them.
  if (rule == SignRule::literal && nonnegative) {
    const Eigen::VectorXd positive = feasible_weights(w, true);
    const Eigen::VectorXd negative = feasible_weights(-w, true);
    return positive.norm() > negative.norm() ? positive : negative;
  }
  return feasible_weights(prefers_negative(w) ? Eigen::VectorXd(-w) : w, nonnegative);
}

Start greedy_start(const BlockSource<double>& X, const SupportFunction& support,
                   const DecompositionOptions& options, const Context& context) {
  const Reduction reduction(X.part().mesh_vertices(), context);
  Residual residual(X, options, reduction);
  for (int k = 0; k < options.count; ++k) {
    context.report(static_cast<double>(k) / options.count);
    const VertexIndex center = residual.strongest();
    if (center < 0) break;
    const Eigen::VectorXd w = reduction.on(X.part().owner(center), [&] {
      return oriented_weights(strongest_motion(residual.at(center)), options.sign_rule,
                              options.nonnegative);
    });
    residual.explain(center, w, support({&center, 1}).col(0));
  }
  return std::move(residual).start();
}

}  // namespace mimetra
