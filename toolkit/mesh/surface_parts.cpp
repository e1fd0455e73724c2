#include "toolkit/mesh/surface_parts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/disjoint_sets.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/surface.h"

namespace mimetra {
namespace {

using RimEdge = std::pair<VertexIndex, VertexIndex>;

/// Edges with one triangle, each with its lower vertex first.
std::vector<RimEdge> boundary_edges(int vertices, const Triangles& welded) {
  std::vector<RimEdge> edges;
  EdgeSides(vertices, welded).for_each_edge([&](std::span<const int> sides) {
    if (sides.size() != 1) return;
    const int t = sides[0] / 3, c = sides[0] % 3;
    edges.emplace_back(std::minmax({welded(t, c), welded(t, (c + 1) % 3)}));
  });
  return edges;
}

struct Boundary {
  std::vector<VertexIndex> vertices;
  double length = 0;
};

/// Boundaries, keyed by their lowest vertex.
std::map<VertexIndex, Boundary> boundaries_of(const Positions& positions,
                                              const std::vector<RimEdge>& edges) {
  DisjointSets joined(static_cast<int>(positions.rows()));
  for (const auto& [low, high] : edges) joined.join(low, high);
  std::map<VertexIndex, Boundary> boundaries;
  std::vector<bool> is_listed(positions.rows(), false);
  for (const RimEdge& edge : edges) {
    Boundary& boundary = boundaries[joined.lowest(edge.first)];
    boundary.length += (positions.row(edge.first) - positions.row(edge.second)).norm();
    for (const VertexIndex v : {edge.first, edge.second}) {
      if (!is_listed[v]) boundary.vertices.push_back(v);
      is_listed[v] = true;
    }
  }
  return boundaries;
}

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

double SurfaceParts::area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

double SurfaceParts::share(int part) const {
  const double all = area();
  return all > 0 ? areas[part] / all : 0;
}

SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles,
                           const Weld& weld) {
  const auto vertices = static_cast<int>(positions.rows());
  if (static_cast<int>(weld.representative.size()) != vertices) {
    throw std::invalid_argument("a weld of " + std::to_string(weld.representative.size()) +
                                " vertices, expected " + std::to_string(vertices));
  }
  const ConnectedComponents connected = connected_components(triangles, weld);
  const Eigen::VectorXd of_vertices = vertex_areas(positions, triangles);
  std::vector<double> areas(connected.count, 0);
  for (VertexIndex v = 0; v < vertices; ++v) areas[connected.of_vertex[v]] += of_vertices[v];
  std::vector<int> order(connected.count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) { return areas[a] > areas[b]; });
  SurfaceParts parts;
  std::vector<int> rank(connected.count, -1);
  for (const int label : order) {
    rank[label] = parts.count();
    parts.areas.push_back(areas[label]);
  }
  for (const int label : connected.of_vertex) parts.of_vertex.push_back(rank[label]);
  return parts;
}

SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles) {
  return surface_parts(positions, triangles, Weld::exact(positions));
}

std::vector<VertexIndex> vertices_of_parts(const SurfaceParts& parts,
                                           const std::vector<VertexIndex>& with) {
  std::vector<bool> has_vertex(parts.areas.size(), false);
  for (const VertexIndex v : with) has_vertex[parts.of_vertex.at(v)] = true;
  std::vector<VertexIndex> all;
  for (std::size_t v = 0; v < parts.of_vertex.size(); ++v) {
    if (has_vertex[parts.of_vertex[v]]) all.push_back(static_cast<VertexIndex>(v));
  }
  return all;
}

Subject subject_around(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices) {
  constexpr double kSectionShare = 1.0 / 3;
  std::vector<VertexIndex> all = vertices_of_parts(parts, vertices);
  const auto diagonal_of = [&](const std::vector<VertexIndex>& some) {
    return box_diagonal(Positions(positions(some, Eigen::all)));
  };
  const double span = diagonal_of(vertices);
  if (span > 0 && span < kSectionShare * diagonal_of(all)) return {vertices, true};
  return {std::move(all)};
}

SubjectBox subject_box(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices) {
  const Subject subject = subject_around(positions, parts, vertices);
  const Positions places = positions(subject.vertices, Eigen::all);
  return {(places.colwise().maxCoeff() + places.colwise().minCoeff()) / 2,
          subject.growth() * box_diagonal(places), subject.is_section};
}

double diameter_of_parts(const Positions& positions, const Triangles& triangles,
                         const std::vector<VertexIndex>& vertices) {
  constexpr double kRounding = 1e-12;
  const double whole = diameter(positions, triangles);
  if (vertices.empty()) return whole;
  const std::vector<VertexIndex> all =
      vertices_of_parts(surface_parts(positions, triangles), vertices);
  const double size = diameter(Positions(positions(all, Eigen::all)));
  return size >= (1 - kRounding) * whole ? whole : size;
}

std::vector<bool> near_rims(const Positions& positions, const Triangles& triangles,
                            const Weld& weld) {
  const SurfaceParts parts = surface_parts(positions, triangles, weld);
  const Triangles welded = weld.welded(triangles);
  const std::map<VertexIndex, Boundary> boundaries =
      boundaries_of(positions, boundary_edges(static_cast<int>(positions.rows()), welded));
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
