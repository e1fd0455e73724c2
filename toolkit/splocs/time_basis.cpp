#include "toolkit/splocs/time_basis.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "toolkit/mesh/parallel.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {
namespace {

// Poses in the first sketch; each further sketch has twice as many.
constexpr Eigen::Index kFirstSketch = 32;

/// Output of SplitMix64 for a state: every bit depends on every bit of it.
///
/// [Steele, Lea, Flood. Fast Splittable Pseudorandom Number Generators. OOPSLA 2014]
std::uint64_t scrambled(std::uint64_t state) {
  state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
  state = (state ^ (state >> 27)) * 0x94d049bb133111ebu;
  return state ^ (state >> 31);
}

/// Random sign for each coordinate of a block's `vertices` and each pose, which depends only on
/// these two. Rows are x of all vertices, then y, then z (3 vertices x poses). `first` is the first
/// vertex.
Eigen::MatrixXd random_signs(Eigen::Index first, Eigen::Index vertices, Eigen::Index poses) {
  constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  Eigen::MatrixXd signs(3 * vertices, poses);
  for (Eigen::Index pose = 0; pose < poses; ++pose) {
    const std::uint64_t of_pose = scrambled(kStep * (static_cast<std::uint64_t>(pose) + 1));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (Eigen::Index v = 0; v < vertices; ++v) {
        const auto coordinate = static_cast<std::uint64_t>(3 * (first + v) + axis);
        signs(axis * vertices + v, pose) = scrambled(of_pose + kStep * coordinate) & 1 ? 1.0 : -1.0;
      }
    }
  }
  return signs;
}

/// Orthonormal basis of `poses` random mixtures of the vertices' motions (F x poses).
Eigen::MatrixXd sketched_basis(const BlockSource<double>& X, Eigen::Index poses,
                               const Reduction& reduction, const Context& context) {
  const VertexPart& part = reduction.part();
  const auto of_run = [&](int run, Eigen::MatrixXd& sum) {
    const IndexRange blocks = part.blocks_of(run);
    for (int b = blocks.first; b < blocks.end; ++b) {
      sum.noalias() += *X.block(b) * random_signs(part.first() + X.first(b), X.size(b), poses);
    }
  };
  const Eigen::MatrixXd sketch = context.sum(part.mesh_runs(), X.rows(), poses, of_run);
  return reduction.on_first([&]() -> Eigen::MatrixXd {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(sketch);
    return qr.householderQ() * Eigen::MatrixXd::Identity(X.rows(), poses);
  });
}

VertexBlocks<double> coordinates(const Eigen::MatrixXd& Q, const BlockSource<double>& X,
                                 const Context& context) {
  VertexBlocks<double> B(Q.cols(), X.part());
  parallel_for(
      X.count(), [&](int b) { B[b] = Q.transpose() * *X.block(b); }, context);
  return B;
}

/// Eigenvalues of B B^T, ascending, with the eigenvector below each.
Eigen::MatrixXd directions_of(const VertexBlocks<double>& B, const Reduction& reduction) {
  const Eigen::Index poses = B.rows();
  const Eigen::MatrixXd gram = reduction.sum(poses, poses, [&](int run, Eigen::MatrixXd& sum) {
    const IndexRange blocks = reduction.part().blocks_of(run);
    for (int b = blocks.first; b < blocks.end; ++b) sum.noalias() += B[b] * B[b].transpose();
  });
  return reduction.on_first([&] {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
    Eigen::MatrixXd directions(1 + poses, poses);
    directions << solver.eigenvalues().transpose(), solver.eigenvectors();
    return directions;
  });
}

}  // namespace

std::optional<TimeBasis> time_basis(const BlockSource<double>& X, double norm2, double tolerance,
                                    Eigen::Index most, const Context& context) {
  const Reduction reduction(X.part().mesh_vertices(), context);
  const Eigen::Index worth = X.rows() / 2;
  for (Eigen::Index poses = std::min(kFirstSketch, worth), tried = 0;
       poses > tried && poses <= most; tried = poses, poses = std::min(2 * poses, worth)) {
    const double from = static_cast<double>(tried) / static_cast<double>(worth),
                 to = static_cast<double>(poses) / static_cast<double>(worth),
                 between = (from + to) / 2;
    const Eigen::MatrixXd sketch = sketched_basis(X, poses, reduction, context.part(from, between));
    const VertexBlocks<double> B = coordinates(sketch, X, context.part(between, to));
    const Eigen::MatrixXd directions = directions_of(B, reduction);
    const Eigen::VectorXd energies = directions.row(0);
    double lost = norm2 - energies.sum();
    if (lost > tolerance * tolerance * norm2) continue;
    // Energies ascend, so drop poses from the front while the tolerance allows.
    Eigen::Index dropped = 0;
    while (dropped + 1 < poses && lost + energies[dropped] <= tolerance * tolerance * norm2) {
      lost += energies[dropped++];
    }
    const Eigen::MatrixXd kept = directions.bottomRightCorner(poses, poses - dropped);
    return TimeBasis{sketch * kept, coordinates(kept, B, context.part(to, to))};
  }
  return std::nullopt;
}

}  // namespace mimetra
