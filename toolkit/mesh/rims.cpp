#include "toolkit/mesh/rims.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/surface_parts.h"

namespace mimetra {

namespace {

using RimEdge = std::pair<VertexIndex, VertexIndex>;

/// Edges of one triangle, by their lower vertex first.
std::vector<RimEdge> boundary_edges(const Triangles& welded) {
  std::map<RimEdge, int> uses;
  for (int t = 0; t < welded.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax({welded(t, c), welded(t, (c + 1) % 3)});
      if (low != high) ++uses[{low, high}];
    }
  }
  std::vector<RimEdge> edges;
  for (const auto& [edge, count] : uses) {
    if (count == 1) edges.push_back(edge);
  }
  return edges;
}

struct Boundary {
  std::vector<VertexIndex> vertices;
  double length = 0;
};

/// Boundaries by their lowest vertex.
std::map<VertexIndex, Boundary> boundaries_of(const Positions& positions,
                                              const std::vector<RimEdge>& edges) {
  std::vector<VertexIndex> lowest(positions.rows());
  std::iota(lowest.begin(), lowest.end(), 0);
  const auto root = [&lowest](VertexIndex v) {
    while (lowest[v] != v) v = lowest[v] = lowest[lowest[v]];
    return v;
  };
  for (const RimEdge& edge : edges) {
    const auto [low, high] = std::minmax({root(edge.first), root(edge.second)});
    lowest[high] = low;
  }
  std::map<VertexIndex, Boundary> boundaries;
  std::vector<bool> is_listed(positions.rows(), false);
  for (const RimEdge& edge : edges) {
    Boundary& boundary = boundaries[root(edge.first)];
    boundary.length += (positions.row(edge.first) - positions.row(edge.second)).norm();
    for (const VertexIndex v : {edge.first, edge.second}) {
      if (!is_listed[v]) boundary.vertices.push_back(v);
      is_listed[v] = true;
    }
  }
  return boundaries;
}

/// The diameter of each connected part.
std::vector<double> diameters_of(const Positions& positions, const SurfaceParts& parts) {
  std::vector<std::vector<Eigen::Index>> members(parts.count());
  for (std::size_t v = 0; v < parts.of_vertex.size(); ++v) {
    members[parts.of_vertex[v]].push_back(static_cast<Eigen::Index>(v));
  }
  std::vector<double> diameters;
  diameters.reserve(members.size());
  for (const auto& vertices : members) {
    diameters.push_back(diameter(positions(vertices, Eigen::all)));
  }
  return diameters;
}

}  // namespace

std::vector<bool> near_rims(const Positions& positions, const Triangles& triangles,
                            const Weld& weld) {
  const SurfaceParts parts = surface_parts(positions, triangles, weld);
  const Triangles welded = weld.welded(triangles);
  const std::map<VertexIndex, Boundary> boundaries =
      boundaries_of(positions, boundary_edges(welded));
  std::vector<const Boundary*> longest(parts.count(), nullptr);
  for (const auto& [lowest, boundary] : boundaries) {
    const Boundary*& most = longest[parts.of_vertex[lowest]];
    if (!most || boundary.length > most->length) most = &boundary;
  }
  const std::vector<double> diameters = diameters_of(positions, parts);
  std::vector<bool> is_rim(positions.rows(), false), is_near = is_rim;
  for (int part = 0; part < parts.count(); ++part) {
    if (!longest[part]) continue;
    const std::vector<VertexIndex>& vertices = longest[part]->vertices;
    if (diameter(positions(vertices, Eigen::all)) < kRimShare * diameters[part]) continue;
    for (const VertexIndex v : vertices) is_rim[v] = true;
  }
  for (int t = 0; t < welded.rows(); ++t) {
    const auto corners = welded.row(t);
    if (std::ranges::none_of(corners, [&](VertexIndex v) { return is_rim[v]; })) continue;
    for (const VertexIndex v : corners) is_near[v] = true;
  }
  for (std::size_t v = 0; v < is_near.size(); ++v) is_near[v] = is_near[weld.representative[v]];
  return is_near;
}

}  // namespace mimetra
