#pragma once

#include <vector>

#include <Eigen/SparseCholesky>

namespace mimetra::geodesic {

/// A sparse symmetric system P A P^T = L D L^T, factored once to solve for many right-hand sides.
///
/// Right-hand sides are the columns of row-major matrices, so that one pass over the factor serves
/// all of them. Eigen's own solve makes one pass for each.
class SparseFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double>;
  /// Eigen's factorization, whose elimination order serves all matrices with the same pattern.
  using Factorization = Eigen::SimplicialLDLT<Matrix>;

  SparseFactor() = default;
  /// Copies the factor. Throws std::runtime_error if the factorization failed.
  explicit SparseFactor(const Factorization& factorization);

  /// Position of each unknown in the elimination order.
  const std::vector<int>& order() const { return order_; }
  /// Diagonal D in elimination order.
  const Eigen::VectorXd& pivots() const { return pivots_; }

  /// Solution for `right`. Both have one row per unknown, in elimination order.
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
  // L without its unit diagonal, by columns: column j has entries starts_[j] to starts_[j + 1] - 1.
  std::vector<int> starts_ = {0}, rows_;
  std::vector<double> values_;
  Eigen::VectorXd pivots_;
};

}  // namespace mimetra::geodesic
