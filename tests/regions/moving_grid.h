#pragma once

#include <limits>

#include "tests/splocs/synthetic.h"
#include "toolkit/regions/regions.h"

/// Components written down by hand on a flat grid of 12 x 5 vertices.
namespace mimetra::test {

constexpr int kColumns = 12;
constexpr int kRows = 5;

/// Component k lifts vertex centers[k] by heights[k] and its grid neighbours by half of that; its
/// weights are 1 in every one of 4 frames.
inline Components lifted(const std::vector<VertexIndex>& centers,
                         const std::vector<double>& heights) {
  const Shape shape = grid(kColumns, kRows);
  const int K = static_cast<int>(centers.size()), N = kColumns * kRows;
  Components components;
  components.rest = shape.positions;
  components.triangles = shape.triangles;
  components.displacements = Frames::Zero(K, 3 * N);
  components.weights = Eigen::MatrixXd::Ones(4, K);
  components.centers = centers;
  components.support = Eigen::MatrixXd::Zero(K, N);
  for (int k = 0; k < K; ++k) {
    if (centers[k] < 0) {
      components.weights.col(k).setZero();
      continue;
    }
    const Eigen::VectorXd distances = straight_distances(shape.positions)(centers[k]);
    for (int v = 0; v < N; ++v) {
      if (distances[v] > 1) continue;
      components.displacements(k, 3 * v + 2) = distances[v] == 0 ? heights[k] : heights[k] / 2;
    }
  }
  return components;
}

inline VertexIndex at(int x, int y) {
  return y * kColumns + x;
}

inline RegionOptions disc_of(const Components& components, double radius) {
  RegionOptions options;
  options.radius = radius;
  options.distances = one_by_one(straight_distances(components.rest));
  return options;
}

}  // namespace mimetra::test
