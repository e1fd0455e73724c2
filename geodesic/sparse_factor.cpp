#include "geodesic/sparse_factor.h"

#include <stdexcept>

namespace mimetra::geodesic {

SparseFactor::SparseFactor(const Factorization& factorization) {
  if (factorization.info() != Eigen::Success) throw std::runtime_error("the system is singular");
  const auto& permutation = factorization.permutationP().indices();
  order_.assign(permutation.begin(), permutation.end());
  pivots_ = factorization.vectorD();
  const Matrix& l = factorization.matrixL().nestedExpression();
  rows_.reserve(l.nonZeros());
  values_.reserve(l.nonZeros());
  for (Eigen::Index j = 0; j < l.cols(); ++j) {
    for (Matrix::InnerIterator entry(l, j); entry; ++entry) {
      if (entry.row() <= j) continue;
      rows_.push_back(static_cast<int>(entry.row()));
      values_.push_back(entry.value());
    }
    starts_.push_back(static_cast<int>(rows_.size()));
  }
}

}  // namespace mimetra::geodesic
