#include "toolkit/regions/falloff.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace mimetra {
namespace {

/// Vertices of weight 1 that share a triangle with another one, ascending.
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

/// 1 at distance 0, 0 from the falloff on.
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
  if (!(falloff > 0 && std::isfinite(falloff))) {
    throw std::invalid_argument("falloff is " + std::to_string(falloff) + "; it must be above 0");
  }
  Eigen::VectorXd faded = joined_weights(weights, weld);
  const std::vector<VertexIndex> rim = rim_of(faded, weld.welded(triangles));
  if (rim.empty()) return faded;
  const Eigen::VectorXd from_rim = distances(rim);
  for (Eigen::Index v = 0; v < faded.size(); ++v) {
    if (faded[v] < 1) faded[v] = std::max(faded[v], bump(from_rim[v], falloff));
  }
  return faded;
}

}  // namespace mimetra
