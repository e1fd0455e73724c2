#include "toolkit/transfer/smooth_edges.h"

#include <Eigen/Geometry>

namespace mimetra {

void add_smoothness(const Positions& rest, const Triangles& triangles, const SmoothEdge& edge,
                    const std::vector<int>& unknown_of_vertex, Triplets& entries) {
  Eigen::Matrix<double, 3, 6> difference;
  difference << hat_gradients(rest, triangles, edge.triangle),
      -hat_gradients(rest, triangles, edge.neighbor);
  std::array<int, 6> unknowns;
  for (int c = 0; c < 3; ++c) {
    unknowns[c] = unknown_of_vertex[triangles(edge.triangle, c)];
    unknowns[3 + c] = unknown_of_vertex[triangles(edge.neighbor, c)];
  }
  add_products<6>(difference, edge.weight, unknowns, entries);
}

PullOverBorder pull_over_border(const Positions& rest, const Triangles& triangles,
                                const SoftBorder& border, const std::vector<SmoothEdge>& edges,
                                const DeformationGradients& gradients) {
  const std::vector<int>& selected = gradients.selected();
  PullOverBorder pull{std::vector<Edges>(selected.size(), Edges::Zero()), {}};
  std::vector<int> place(triangles.rows(), -1);
  for (std::size_t s = 0; s < selected.size(); ++s) place[selected[s]] = static_cast<int>(s);
  const auto ask = [&](int triangle, int neighbor, double weight) {
    const double wanted = weight * border.share(triangle);
    if (wanted == 0 || place[triangle] < 0) return;
    const HatGradients own = hat_gradients(rest, triangles, triangle);
    const HatGradients others = hat_gradients(rest, triangles, neighbor);
    const Eigen::Vector3d normal = own.col(1).cross(own.col(2)).normalized();
    const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    pull.own[place[triangle]] += wanted * own.rightCols<2>();
    pull.crossings.push_back({place[triangle], neighbor, -wanted * plane * others.rightCols<2>()});
  };
  for (const SmoothEdge& edge : edges) {
    ask(edge.triangle, edge.neighbor, edge.weight);
    ask(edge.neighbor, edge.triangle, edge.weight);
  }
  return pull;
}

}  // namespace mimetra
