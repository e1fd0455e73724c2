#include "toolkit/transfer/gradient_system.h"

#include <stdexcept>

#include <Eigen/Geometry>

#include "toolkit/mesh/disjoint_sets.h"

namespace mimetra {
namespace {

/// Lowest vertex of each vertex's piece.
std::vector<VertexIndex> pieces(const Triangles& triangles, const std::vector<double>& weights,
                                const Weld& weld) {
  const auto vertices = static_cast<int>(weld.representative.size());
  DisjointSets sets(vertices);
  for (VertexIndex v = 0; v < vertices; ++v) sets.join(v, weld.representative[v]);
  for (int t = 0; t < triangles.rows(); ++t) {
    if (weights[t] == 0) continue;
    for (const int corner : {1, 2}) sets.join(triangles(t, 0), triangles(t, corner));
  }
  std::vector<VertexIndex> piece(vertices);
  for (VertexIndex v = 0; v < vertices; ++v) piece[v] = sets.lowest(v);
  return piece;
}

}  // namespace

VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed, const Weld& weld) {
  const auto vertices = static_cast<int>(fixed.size());
  const std::vector<VertexIndex> piece = pieces(triangles, weights, weld);
  std::vector<bool> held(vertices, false);
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (fixed[v]) held[piece[v]] = true;
  }
  VertexUnknowns unknowns;
  unknowns.of_vertex.assign(vertices, -1);
  std::vector<int> number(vertices, -1);  // of each piece, stored at its lowest vertex
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (fixed[v]) continue;
    const VertexIndex lowest = piece[v], one = weld.representative[v];
    if (!held[lowest]) {
      if (v == lowest) {
        number[v] = static_cast<int>(unknowns.floating.size());
        unknowns.floating.emplace_back();
      }
      FloatingPiece& floats = unknowns.floating[number[lowest]];
      if (v == one) floats.vertices.push_back(v);
      if (one == lowest) {
        floats.pin.push_back(v);
        continue;
      }
    } else if (v == one) {
      if (number[lowest] < 0) {
        number[lowest] = static_cast<int>(unknowns.held.size());
        unknowns.held.emplace_back();
      }
      unknowns.held[number[lowest]].push_back(v);
    }
    unknowns.of_vertex[v] = v == one ? unknowns.count++ : unknowns.of_vertex[one];
  }
  return unknowns;
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
