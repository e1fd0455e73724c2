#include "toolkit/mesh/stray_vertices.h"

#include <algorithm>

namespace mimetra {

namespace {

/// Of the edges at each vertex (N).
Eigen::VectorXd longest_edges(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(positions.rows());
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      const double length = (positions.row(a) - positions.row(b)).norm();
      longest[a] = std::max(longest[a], length);
      longest[b] = std::max(longest[b], length);
    }
  }
  return longest;
}

}  // namespace

StrayVertices::StrayVertices(const Positions& rest, const Triangles& triangles)
    : triangles_(triangles),
      at_rest_(from_neighbors(PositionsView(rest.data(), rest.rows(), 3))),
      edges_(longest_edges(rest, triangles)) {}

Eigen::VectorXd StrayVertices::from_neighbors(const PositionsView& pose) const {
  Positions sums = Positions::Zero(pose.rows(), 3);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(pose.rows());
  for (const auto& corners : triangles_.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      sums.row(corners[c]) += pose.row(corners[(c + 1) % 3]) + pose.row(corners[(c + 2) % 3]);
      counts[corners[c]] += 2;
    }
  }
  Eigen::VectorXd distances = Eigen::VectorXd::Zero(pose.rows());
  for (Eigen::Index v = 0; v < pose.rows(); ++v) {
    if (counts[v] > 0) distances[v] = (pose.row(v) - sums.row(v) / counts[v]).norm();
  }
  return distances;
}

Eigen::VectorXd StrayVertices::distances(const PositionsView& pose) const {
  return from_neighbors(pose) - at_rest_;
}

bool StrayVertices::is_torn_off(VertexIndex vertex, double distance, double size,
                                double scale) const {
  return distance > scale * kStray * size && distance > scale * edges_[vertex];
}

}  // namespace mimetra
