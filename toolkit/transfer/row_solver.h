#pragma once

#include <vector>

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

  /// Row of `solve` where unknown i of the system stands: its place in the elimination.
  const std::vector<int>& order() const { return order_; }

  /// The solution for `right`, both in the order of elimination.
  /// \pre right.rows() is the system's size
  Rows solve(Rows right) const;

 private:
  void keep_factor(const Eigen::SparseMatrix<double>& l);

  std::vector<int> order_;
  // L of P A P^T = L D L^T without its diagonal of ones, by columns: those of column j are entries
  // starts_[j] to starts_[j + 1] - 1.
  std::vector<int> starts_ = {0}, rows_;
  std::vector<double> values_;
  Eigen::VectorXd inverse_pivots_;
};

}  // namespace mimetra
