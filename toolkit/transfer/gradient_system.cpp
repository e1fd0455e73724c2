#include "toolkit/transfer/gradient_system.h"

#include <stdexcept>

#include <Eigen/LU>

#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {

HatGradients hat_gradients(const Positions& rest, const Triangles& triangles, int triangle) {
  const Eigen::Matrix3d inverse = triangle_frame(rest, triangles, triangle).inverse();
  HatGradients gradients;
  gradients.col(1) = inverse.row(0).transpose();
  gradients.col(2) = inverse.row(1).transpose();
  gradients.col(0) = -gradients.col(1) - gradients.col(2);
  return gradients;
}

double target_share(double quality) {
  const double share = own_share(quality);
  return share * share;
}

geodesic::SparseFactor factor_of(const Triplets& entries, int unknowns) {
  if (unknowns == 0) return {};
  Eigen::SparseMatrix<double> system(unknowns, unknowns);
  system.setFromTriplets(entries.begin(), entries.end());
  const geodesic::SparseFactor::Factorization factorization(system);
  if (factorization.info() == Eigen::Success) {
    geodesic::SparseFactor factor(factorization);
    if (factor.pivots().minCoeff() > 0) return factor;
  }
  throw std::runtime_error(
      "the target's triangles do not determine its vertices; look for nearly degenerate ones");
}

}  // namespace mimetra
