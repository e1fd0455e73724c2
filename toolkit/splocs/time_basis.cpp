#include "toolkit/splocs/time_basis.h"

#include <algorithm>
#include <random>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "toolkit/splocs/block_sums.h"

namespace mimetra {
namespace {

// Poses in the first sketch; each further one has twice as many.
constexpr Eigen::Index kFirstSketch = 32;

/// Random signs, the same in every run.
Eigen::MatrixXd random_signs(Eigen::Index rows, Eigen::Index columns, int seed) {
  std::mt19937 generator(static_cast<std::mt19937::result_type>(seed));
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return generator() & 1 ? 1.0 : -1.0; });
}

/// `poses` random mixtures of the vertices' motions, orthonormalised (F x poses).
Eigen::MatrixXd sketched_basis(const VertexBlocks<double>& X, Eigen::Index poses, int threads) {
  const auto parts =
      sums_over_runs<Eigen::MatrixXd>(X.count(), threads, [&](int b, Eigen::MatrixXd& part) {
        if (part.size() == 0) part.setZero(X.rows(), poses);
        part.noalias() += X[b] * random_signs(X[b].cols(), poses, b);
      });
  Eigen::MatrixXd sketch = Eigen::MatrixXd::Zero(X.rows(), poses);
  for (const Eigen::MatrixXd& part : parts) sketch += part;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(sketch);
  return qr.householderQ() * Eigen::MatrixXd::Identity(X.rows(), poses);
}

VertexBlocks<double> coordinates(const Eigen::MatrixXd& Q, const VertexBlocks<double>& X,
                                 int threads) {
  VertexBlocks<double> B(Q.cols(), X.vertices());
  parallel_for(X.count(), threads, [&](int b) { B[b] = Q.transpose() * X[b]; });
  return B;
}

}  // namespace

std::optional<TimeBasis> time_basis(const VertexBlocks<double>& X, double norm2, double tolerance,
                                    int threads) {
  const Eigen::Index most = X.rows() / 2;
  for (Eigen::Index poses = std::min(kFirstSketch, most), tried = 0; poses > tried;
       tried = poses, poses = std::min(2 * poses, most)) {
    const Eigen::MatrixXd sketch = sketched_basis(X, poses, threads);
    const VertexBlocks<double> B = coordinates(sketch, X, threads);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(poses, poses);
    for (int b = 0; b < B.count(); ++b) gram.noalias() += B[b] * B[b].transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(gram);
    const Eigen::VectorXd& energies = directions.eigenvalues();
    double lost = norm2 - energies.sum();
    if (lost > tolerance * tolerance * norm2) continue;
    // Energies ascend: what may still be lost is lost from the front.
    Eigen::Index dropped = 0;
    while (dropped + 1 < poses && lost + energies[dropped] <= tolerance * tolerance * norm2) {
      lost += energies[dropped++];
    }
    const Eigen::MatrixXd kept = directions.eigenvectors().rightCols(poses - dropped);
    return TimeBasis{sketch * kept, coordinates(kept, B, threads)};
  }
  return std::nullopt;
}

}  // namespace mimetra
