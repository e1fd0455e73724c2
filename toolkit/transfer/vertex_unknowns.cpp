#include "toolkit/transfer/vertex_unknowns.h"

#include <algorithm>

namespace mimetra {

namespace {

/// Lowest vertex of each vertex's piece.
std::vector<VertexIndex> pieces(const Triangles& triangles, const std::vector<double>& weights,
                                const Weld& weld) {
  std::vector<VertexIndex> parent = weld.representative;
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
  std::vector<VertexIndex> piece(parent.size());
  for (std::size_t v = 0; v < piece.size(); ++v) piece[v] = root(static_cast<VertexIndex>(v));
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
  std::vector<int> number(vertices, -1);  // of each piece, at its lowest vertex
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

}  // namespace mimetra
