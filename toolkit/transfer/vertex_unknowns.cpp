#include "toolkit/transfer/vertex_unknowns.h"

#include <algorithm>
#include <numeric>

namespace mimetra {

namespace {

/// Lowest vertex of each vertex's piece.
std::vector<VertexIndex> pieces(int vertices, const Triangles& triangles,
                                const std::vector<double>& weights) {
  std::vector<VertexIndex> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](VertexIndex v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (int t = 0; t < triangles.rows(); ++t) {
    if (weights[t] == 0) continue;
    for (const int corner : {1, 2}) {
      const auto [low, high] = std::minmax({root(triangles(t, 0)), root(triangles(t, corner))});
      parent[high] = low;
    }
  }
  std::vector<VertexIndex> piece(vertices);
  for (VertexIndex v = 0; v < vertices; ++v) piece[v] = root(v);
  return piece;
}

}  // namespace

VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed) {
  const auto vertices = static_cast<int>(fixed.size());
  const std::vector<VertexIndex> piece = pieces(vertices, triangles, weights);
  std::vector<bool> held(vertices, false);
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (fixed[v]) held[piece[v]] = true;
  }
  VertexUnknowns unknowns;
  unknowns.of_vertex.assign(vertices, -1);
  std::vector<int> floating(vertices, -1);
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (fixed[v]) continue;
    const VertexIndex lowest = piece[v];
    if (!held[lowest]) {
      if (v == lowest) {
        floating[v] = static_cast<int>(unknowns.floating.size());
        unknowns.floating.emplace_back();
      }
      unknowns.floating[floating[lowest]].vertices.push_back(v);
      if (v == lowest) continue;
    }
    unknowns.some_held |= held[lowest];
    unknowns.of_vertex[v] = unknowns.count++;
  }
  return unknowns;
}

}  // namespace mimetra
