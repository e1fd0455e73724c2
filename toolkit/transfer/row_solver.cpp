#include <mimetra/transfer/row_solver.h>

#include <stdexcept>

#include <Eigen/SparseCholesky>

namespace mimetra {

namespace {

using Row = Eigen::Array<double, 1, RowSolver::kWidth>;

}  // namespace

RowSolver::RowSolver(const Eigen::SparseMatrix<double>& system) {
  if (system.rows() == 0) return;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) {
    throw std::runtime_error(
        "the target's triangles do not determine its vertices; look for nearly degenerate ones");
  }
  inverse_pivots_ = factor.vectorD().cwiseInverse();
  const auto& permutation = factor.permutationP().indices();
  order_.assign(permutation.begin(), permutation.end());
  keep_factor(factor.matrixL().nestedExpression());
}

void RowSolver::keep_factor(const Eigen::SparseMatrix<double>& l) {
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  rows_.reserve(l.nonZeros());
  values_.reserve(l.nonZeros());
  for (Eigen::Index j = 0; j < l.cols(); ++j) {
    for (Entry entry(l, j); entry; ++entry) {
      if (entry.row() <= j) continue;
      rows_.push_back(static_cast<int>(entry.row()));
      values_.push_back(entry.value());
    }
    starts_.push_back(static_cast<int>(rows_.size()));
  }
}

RowSolver::Rows RowSolver::solve(Rows right) const {
  const auto row = [&right](int i) {
    return Eigen::Map<Row>(right.data() + Eigen::Index{kWidth} * i);
  };
  const auto size = static_cast<int>(right.rows());
  for (int j = 0; j < size; ++j) {
    const Row here = row(j);
    for (int e = starts_[j]; e < starts_[j + 1]; ++e) row(rows_[e]) -= values_[e] * here;
  }
  for (int j = size - 1; j >= 0; --j) {
    Row here = inverse_pivots_[j] * row(j);
    for (int e = starts_[j]; e < starts_[j + 1]; ++e) here -= values_[e] * row(rows_[e]);
    row(j) = here;
  }
  return right;
}

}  // namespace mimetra
