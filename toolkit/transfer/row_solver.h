#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace mimetra {

/// A sparse symmetric positive definite system, factored once, for many right-hand sides at a time.
///
/// Right-hand sides lie side by side in rows, so that one pass over the factor serves them all;
/// Eigen's own solve passes once for each.
class RowSolver {
 public:
  static constexpr int kWidth = 48;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kWidth, Eigen::RowMajor>;

  /// Throws std::runtime_error where `system` is not positive definite.
  explicit RowSolver(const Eigen::SparseMatrix<double>& system);

  /// \pre right.rows() is the system's size
  Rows solve(const Rows& right) const;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::VectorXd inverse_pivots_;
};

}  // namespace mimetra
