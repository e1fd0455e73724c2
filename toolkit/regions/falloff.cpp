#include "toolkit/regions/falloff.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

void check_falloff(double falloff) {
  if (falloff > 0 && std::isfinite(falloff)) return;
  throw std::invalid_argument("falloff is " + std::to_string(falloff) + "; it must be above 0");
}

/// Vertices of weight 1 that share a triangle with another weight, ascending.
std::vector<VertexIndex> rim_of(const Eigen::VectorXd& weights, const Triangles& triangles) {
  std::vector<bool> on_rim(weights.size(), false);
  for (const auto& corners : triangles.rowwise()) {
    const bool leaves = (weights(corners).array() != 1).any();
    for (const VertexIndex v : corners) {
      if (leaves && weights[v] == 1) on_rim[v] = true;
    }
  }
  std::vector<VertexIndex> rim;
  for (VertexIndex v = 0; v < weights.size(); ++v) {
    if (on_rim[v]) rim.push_back(v);
  }
  return rim;
}

/// 1 at distance 0, falling to 0 at the falloff.
double bump(double distance, double falloff) {
  if (!(distance < falloff)) return 0;
  const double t = distance / falloff;
  return (1 - t) * (1 - t) * (1 + 2 * t);
}

}  // namespace

Eigen::VectorXd joined_weights(const Eigen::VectorXd& weights, const Weld& weld) {
  Eigen::VectorXd joined = weights;
  for (Eigen::Index v = 0; v < joined.size(); ++v) {
    double& of_place = joined[weld.representative[v]];
    of_place = std::max(of_place, weights[v]);
  }
  for (Eigen::Index v = 0; v < joined.size(); ++v) joined[v] = joined[weld.representative[v]];
  return joined;
}

Eigen::VectorXd fading_out(const Eigen::VectorXd& weights, const Triangles& triangles,
                           const Weld& weld, double falloff, const NearestDistance& distances) {
  check_falloff(falloff);
  Eigen::VectorXd faded = joined_weights(weights, weld);
  const std::vector<VertexIndex> rim = rim_of(faded, weld.welded(triangles));
  if (rim.empty()) return faded;
  const Eigen::VectorXd from_rim = distances(rim);
  for (Eigen::Index v = 0; v < faded.size(); ++v) {
    if (faded[v] < 1) faded[v] = std::max(faded[v], bump(from_rim[v], falloff));
  }
  return faded;
}

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
  check_falloff(falloff);
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
    // The factor is nearly 1 for small bumps, so that shares stay close to them.
    if (sum > 0) shares.row(v).head(count) *= (1 - outside) / sum;
    shares(v, count) = sum > 0 ? outside : 1;
  }
  return shares.sparseView(1, 0);
}

}  // namespace mimetra
