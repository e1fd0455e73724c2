#include <mimetra/transfer/row_solver.h>

#include <stdexcept>

namespace mimetra {

RowSolver::RowSolver(const Eigen::SparseMatrix<double>& system) {
  if (system.rows() == 0) return;
  factor_.compute(system);
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0)) {
    throw std::runtime_error(
        "the target's triangles do not determine its vertices; look for nearly degenerate ones");
  }
  inverse_pivots_ = factor_.vectorD().cwiseInverse();
}

RowSolver::Rows RowSolver::solve(const Rows& right) const {
  if (right.rows() == 0) return right;
  // P A P^T = L D L^T: one sweep down and one up over the columns of L.
  Rows x = factor_.permutationP() * right;
  const auto& l = factor_.matrixL().nestedExpression();
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  for (Eigen::Index j = 0; j < l.cols(); ++j) {
    for (Entry entry(l, j); entry; ++entry) {
      if (entry.row() > j) x.row(entry.row()) -= entry.value() * x.row(j);
    }
  }
  x = inverse_pivots_.asDiagonal() * x;
  for (Eigen::Index j = l.cols() - 1; j >= 0; --j) {
    for (Entry entry(l, j); entry; ++entry) {
      if (entry.row() > j) x.row(j) -= entry.value() * x.row(entry.row());
    }
  }
  return factor_.permutationPinv() * x;
}

}  // namespace mimetra
