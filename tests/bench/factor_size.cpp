#include "tests/bench/factor_size.h"

#include <vector>

#include <Eigen/SparseCholesky>

namespace mimetra::bench {

FactorSize factor_size(int vertices, const Triangles& triangles) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < vertices; ++v) entries.emplace_back(v, v, 1);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = triangles(t, corner), b = triangles(t, (corner + 1) % 3);
      entries.emplace_back(a, a, 1);
      entries.emplace_back(b, b, 1);
      entries.emplace_back(a, b, -1);
      entries.emplace_back(b, a, -1);
    }
  }
  Eigen::SparseMatrix<double> matrix(vertices, vertices);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const auto& below = solver.matrixL().nestedExpression();
  FactorSize factor;
  factor.entries = vertices + static_cast<double>(below.nonZeros());
  for (int column = 0; column < vertices; ++column) {
    const double height = below.outerIndexPtr()[column + 1] - below.outerIndexPtr()[column];
    factor.factor_flops += height * height;
  }
  return factor;
}

}  // namespace mimetra::bench
