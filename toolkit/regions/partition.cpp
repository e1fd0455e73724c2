#include "toolkit/regions/partition.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// Vertices of a region, with all others at their places.
std::vector<bool> held_by(const std::vector<VertexIndex>& region, const Weld& weld,
                          std::size_t number) {
  const std::size_t vertices = weld.representative.size();
  std::vector<bool> place(vertices, false), held(vertices, false);
  for (const VertexIndex v : region) {
    if (v < 0 || static_cast<std::size_t>(v) >= vertices) {
      throw MismatchError("region " + std::to_string(number) + " holds vertex " +
                          std::to_string(v) + "; the mesh has vertices 0 to " +
                          std::to_string(vertices - 1));
    }
    place[weld.representative[v]] = true;
  }
  for (std::size_t v = 0; v < vertices; ++v) held[v] = place[weld.representative[v]];
  return held;
}

/// Vertices of a region that share a triangle with one outside, ascending.
std::vector<VertexIndex> rim_of(const std::vector<bool>& held, const Triangles& triangles) {
  std::vector<bool> on_rim(held.size(), false);
  for (const auto& corners : triangles.rowwise()) {
    const bool leaves = !held[corners[0]] || !held[corners[1]] || !held[corners[2]];
    for (const VertexIndex v : corners) {
      if (leaves && held[v]) on_rim[v] = true;
    }
  }
  std::vector<VertexIndex> rim;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (on_rim[v]) rim.push_back(static_cast<VertexIndex>(v));
  }
  return rim;
}

/// 1 at distance 0, 0 from the falloff on.
double bump(double distance, double falloff) {
  if (!(distance < falloff)) return 0;
  const double t = distance / falloff;
  return (1 - t) * (1 - t) * (1 + 2 * t);
}

Eigen::VectorXd bump_around(const std::vector<bool>& held, const Triangles& triangles,
                            double falloff, const NearestDistance& distances) {
  Eigen::VectorXd values(held.size());
  for (std::size_t v = 0; v < held.size(); ++v) values[static_cast<Eigen::Index>(v)] = held[v];
  const std::vector<VertexIndex> rim = rim_of(held, triangles);
  if (rim.empty()) return values;
  const Eigen::VectorXd from_rim = distances(rim);
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    if (!held[v]) values[v] = bump(from_rim[v], falloff);
  }
  return values;
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
  const Triangles welded = weld.welded(triangles);
  Eigen::MatrixXd shares(vertices, count + 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::vector<bool> held = held_by(regions[k], weld, k);
    shares.col(k) = bump_around(held, welded, falloff, distances);
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
