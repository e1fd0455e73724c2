#include "toolkit/regions/partition.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// 1 in a region, 0 elsewhere.
Eigen::VectorXd held_by(const std::vector<VertexIndex>& region, std::size_t number,
                        Eigen::Index vertices) {
  Eigen::VectorXd held = Eigen::VectorXd::Zero(vertices);
  for (const VertexIndex v : region) {
    if (v < 0 || v >= vertices) {
      throw MismatchError("region " + std::to_string(number) + " holds vertex " +
                          std::to_string(v) + "; the mesh has vertices 0 to " +
                          std::to_string(vertices - 1));
    }
    held[v] = 1;
  }
  return held;
}

}  // namespace

Eigen::SparseMatrix<double> partition_of_unity(const Triangles& triangles, const Weld& weld,
                                               const std::vector<std::vector<VertexIndex>>& regions,
                                               double falloff, const NearestDistance& distances) {
  if (!(falloff > 0 && std::isfinite(falloff))) {
    throw std::invalid_argument("falloff is " + std::to_string(falloff) + "; it must be above 0");
  }
  const auto vertices = static_cast<Eigen::Index>(weld.representative.size());
  const auto count = static_cast<Eigen::Index>(regions.size());
  Eigen::MatrixXd shares(vertices, count + 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    shares.col(k) =
        fading_out(held_by(regions[k], k, vertices), triangles, weld, falloff, distances);
  }
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const double sum = shares.row(v).head(count).sum();
    const double outside = (1 - shares.row(v).head(count).array()).prod();
    // Where bumps are small this is nearly 1: the sum is what the regions claim.
    if (sum > 0) shares.row(v).head(count) *= (1 - outside) / sum;
    shares(v, count) = sum > 0 ? outside : 1;
  }
  return shares.sparseView(1, 0);
}

}  // namespace mimetra
