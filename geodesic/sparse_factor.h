#pragma once

#include <vector>

#include <Eigen/SparseCholesky>

namespace mimetra::geodesic {

/// A sparse symmetric system P A P^T = L D L^T, factored once, for many right-hand sides at a time.
///
/// Right-hand sides lie side by side in rows, so that one pass over the factor serves them all;
/// Eigen's own solve passes once for each.
class SparseFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double>;
  /// Finds the order of elimination, which serves all matrices of one pattern.
  using Factorization = Eigen::SimplicialLDLT<Matrix>;

  SparseFactor() = default;
  /// Throws std::runtime_error where there is no factor.
  explicit SparseFactor(const Factorization& factorization);

  /// Place of each unknown in the elimination.
  const std::vector<int>& order() const { return order_; }
  /// D, in the order of elimination.
  const Eigen::VectorXd& pivots() const { return pivots_; }

  /// The solution for `right`, both with one unknown a row, in the order of elimination.
  /// \pre right.rows() is the system's size
  template <int Width>
  Eigen::Matrix<double, Eigen::Dynamic, Width, Eigen::RowMajor> solve(
      Eigen::Matrix<double, Eigen::Dynamic, Width, Eigen::RowMajor> right) const {
    using Row = Eigen::Array<double, 1, Width>;
    const auto row = [&right](int i) {
      return Eigen::Map<Row>(right.data() + Eigen::Index{Width} * i);
    };
    const auto size = static_cast<int>(right.rows());
    for (int j = 0; j < size; ++j) {
      const Row here = row(j);
      for (int e = starts_[j]; e < starts_[j + 1]; ++e) row(rows_[e]) -= values_[e] * here;
    }
    for (int j = size - 1; j >= 0; --j) {
      Row here = row(j) / pivots_[j];
      for (int e = starts_[j]; e < starts_[j + 1]; ++e) here -= values_[e] * row(rows_[e]);
      row(j) = here;
    }
    return right;
  }

 private:
  std::vector<int> order_;
  // L without its diagonal of ones, by columns: those of column j are entries starts_[j] to
  // starts_[j + 1] - 1.
  std::vector<int> starts_ = {0}, rows_;
  std::vector<double> values_;
  Eigen::VectorXd pivots_;
};

}  // namespace mimetra::geodesic
