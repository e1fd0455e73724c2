#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "geodesic/sparse_factor.h"
#include "toolkit/mesh/tri_mesh.h"

/// The system of gradient products that vertices are solved for by. Internal to those who solve it.
namespace mimetra {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Gradients of the three hat functions of a triangle in its plane, one a column.
using HatGradients = Eigen::Matrix3d;

HatGradients hat_gradients(const Positions& rest, const Triangles& triangles, int triangle);

/// How much a triangle of the target counts. Its stiffness grows as 1 / quality^2 and its normal
/// loses its sense: from sound to degenerate it fades out faster than that, without a jump.
double target_share(double quality);

/// Adds scale * X^T X at the unknowns of X's columns; -1 for none.
template <int Columns>
void add_products(const Eigen::Matrix<double, 3, Columns>& x, double scale,
                  const std::array<int, Columns>& unknowns, Triplets& entries) {
  const Eigen::Matrix<double, Columns, Columns> products = scale * x.transpose() * x;
  for (int a = 0; a < Columns; ++a) {
    for (int b = 0; b < Columns; ++b) {
      if (unknowns[a] < 0 || unknowns[b] < 0) continue;
      entries.emplace_back(unknowns[a], unknowns[b], products(a, b));
    }
  }
}

/// The factor of a system of `unknowns`, none for 0 of them. Throws std::runtime_error where the
/// triangles do not determine the vertices.
geodesic::SparseFactor factor_of(const Triplets& entries, int unknowns);

}  // namespace mimetra
