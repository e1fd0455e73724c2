#pragma once

#include <vector>

#include <Eigen/Core>

#include "toolkit/model/second_differences.h"

namespace mimetra {

/// The system of temporal smoothing, H = blockdiag(G_f) + mu D2^T D2 with D2 the second differences
/// over time, on F x D matrices (one row a frame). It couples frames at most two apart: two frames
/// taken as one block make it block tridiagonal.
class TemporalSystem {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// `grams`: D x D, one for all frames or one for each; `differences` F - 2 rows. \pre F >= 3
  TemporalSystem(std::vector<Eigen::MatrixXd> grams, SecondDifferences differences, double mu);

  /// H x (F x D).
  Rows product(const Rows& x) const;

  /// The diagonal of H (F x D).
  Rows diagonal() const;

  /// A bound of the largest sum of absolute entries in a row of H.
  double norm() const;

  /// Factors H + diag(extra). Where `free` (F x D of 0 and 1) is 0, the unknown is decoupled from
  /// the others. Throws std::runtime_error where that is not positive definite.
  void factorize(const Rows& extra, const Rows& free);

  /// Solves the system factored last, for one right-hand side (F x D).
  Rows solve(const Rows& right) const;

 private:
  Eigen::Index first(Eigen::Index block) const { return 2 * block; }
  Eigen::Index size(Eigen::Index block) const;
  Eigen::Index blocks() const { return (frames_ + 1) / 2; }
  const Eigen::MatrixXd& gram(Eigen::Index frame) const;
  double coupling(Eigen::Index a, Eigen::Index b) const;
  Eigen::MatrixXd diagonal_block(Eigen::Index block, const Rows& extra, const Rows& free) const;
  Eigen::MatrixXd lower_block(Eigen::Index block, const Rows& free) const;

  std::vector<Eigen::MatrixXd> grams_;
  SecondDifferences differences_;
  Eigen::Index frames_;
  double mu_;
  std::vector<Eigen::MatrixXd> cholesky_;  // L_k, lower triangles
  std::vector<Eigen::MatrixXd> below_;     // W_k = H_(k+1)k L_k^-T
};

}  // namespace mimetra
