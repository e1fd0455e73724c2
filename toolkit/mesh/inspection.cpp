#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/triangle_quality.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Sorted edge lists, not half-edges: every mesh must be counted here, also those that OpenMesh
/// cannot hold (edges of three triangles, triangles that repeat a vertex).
struct Edge {
  VertexIndex low, high;
  int triangle;

  bool same_place(const Edge& other) const { return low == other.low && high == other.high; }
  auto operator<=>(const Edge&) const = default;
};

enum class Collapsed { skipped, kept };

bool repeats_vertex(const Triangles& triangles, Eigen::Index t) {
  return triangles(t, 0) == triangles(t, 1) || triangles(t, 1) == triangles(t, 2) ||
         triangles(t, 2) == triangles(t, 0);
}

std::vector<Edge> sorted_edges(const Triangles& triangles, Collapsed collapsed) {
  std::vector<Edge> edges;
  edges.reserve(triangles.size());
  for (int t = 0; t < triangles.rows(); ++t) {
    if (collapsed == Collapsed::skipped && repeats_vertex(triangles, t)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const auto [low, high] = std::minmax({triangles(t, corner), triangles(t, (corner + 1) % 3)});
      if (low != high) edges.push_back({low, high, t});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Calls `visit(first, last)` for the triangles of each edge.
template <typename Visit>
void for_each_edge(const std::vector<Edge>& edges, Visit visit) {
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(),
                                   [&](const Edge& edge) { return !edge.same_place(*first); });
    visit(first, last);
    first = last;
  }
}

struct EdgeCounts {
  int boundary = 0;
  int nonmanifold = 0;
  int inconsistent = 0;
};

/// Whether the edge's triangle leads from its lower vertex to the higher.
bool leads_up(const Triangles& triangles, const Edge& edge) {
  for (int corner = 0; corner < 3; ++corner) {
    if (triangles(edge.triangle, corner) == edge.low) {
      return triangles(edge.triangle, (corner + 1) % 3) == edge.high;
    }
  }
  return false;
}

EdgeCounts count_edges(const Triangles& triangles) {
  EdgeCounts counts;
  // A triangle that repeats a vertex has no inside that could lie on a side of an edge.
  for_each_edge(sorted_edges(triangles, Collapsed::skipped), [&](auto first, auto last) {
    if (last - first == 1) ++counts.boundary;
    if (last - first > 2) ++counts.nonmanifold;
    if (last - first == 2 && leads_up(triangles, *first) == leads_up(triangles, *(first + 1))) {
      ++counts.inconsistent;
    }
  });
  return counts;
}

void check_indices(int vertices, const Triangles& triangles) {
  for (int t = 0; t < triangles.rows(); ++t) {
    for (const VertexIndex vertex : triangles.row(t)) {
      if (vertex >= 0 && vertex < vertices) continue;
      throw std::invalid_argument("triangle " + std::to_string(t) + " uses vertex " +
                                  std::to_string(vertex) + ", expected 0 to " +
                                  std::to_string(vertices - 1));
    }
  }
}

/// Lowest vertex of the set that holds `vertex`; shortens the way for the next question.
VertexIndex root(std::vector<VertexIndex>& parent, VertexIndex vertex) {
  while (parent[vertex] != vertex) {
    parent[vertex] = parent[parent[vertex]];
    vertex = parent[vertex];
  }
  return vertex;
}

void join(std::vector<VertexIndex>& parent, VertexIndex a, VertexIndex b) {
  const auto [low, high] = std::minmax({root(parent, a), root(parent, b)});
  parent[high] = low;
}

int components_with_triangle(int vertices, const Triangles& triangles) {
  const ConnectedComponents components = connected_components(vertices, triangles);
  std::vector<char> seen(components.count, 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    seen[components.of_vertex[triangles(t, 0)]] = 1;
  }
  return static_cast<int>(std::count(seen.begin(), seen.end(), 1));
}

std::vector<int> degenerate_triangles(const Positions& positions, const Triangles& triangles) {
  std::vector<int> degenerate;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (!has_area(positions, triangles, t)) degenerate.push_back(t);
  }
  return degenerate;
}

std::vector<VertexIndex> vertices_without_face(int vertices, const Triangles& triangles) {
  std::vector<char> used(vertices, 0);
  for (const VertexIndex vertex : triangles.reshaped()) used[vertex] = 1;
  std::vector<VertexIndex> unused;
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    if (!used[vertex]) unused.push_back(vertex);
  }
  return unused;
}

}  // namespace

ConnectedComponents connected_components(int vertices, const Triangles& triangles) {
  check_indices(vertices, triangles);
  std::vector<VertexIndex> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    join(parent, triangles(t, 0), triangles(t, 1));
    join(parent, triangles(t, 0), triangles(t, 2));
  }
  ConnectedComponents components;
  components.of_vertex.resize(vertices);
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    // A root is its set's lowest vertex, so its label is known before anybody else asks for it.
    const VertexIndex lowest = root(parent, vertex);
    components.of_vertex[vertex] =
        lowest == vertex ? components.count++ : components.of_vertex[lowest];
  }
  return components;
}

int almost_welded_vertices(const Positions& positions, const Triangles& triangles) {
  const Weld weld = Weld::exact(positions);
  constexpr double kAlmost = 1e-6;
  const double reach = kAlmost * diameter(positions, triangles);
  // Along a line that no grid is straight to.
  const Eigen::VectorXd along = positions * Eigen::Vector3d(1, 1.7, 2.3).normalized();
  std::vector<VertexIndex> order;
  for (const VertexIndex v : surface_vertices(positions, triangles)) {
    order.push_back(weld.representative[static_cast<std::size_t>(v)]);
  }
  std::ranges::sort(order, {}, [&along](VertexIndex v) { return std::pair(along[v], v); });
  order.erase(std::unique(order.begin(), order.end()), order.end());
  const auto has_near = [&](std::ptrdiff_t i, std::ptrdiff_t step) {
    const VertexIndex v = order[static_cast<std::size_t>(i)];
    for (std::ptrdiff_t j = i + step; j >= 0 && j < std::ssize(order); j += step) {
      const VertexIndex other = order[static_cast<std::size_t>(j)];
      if (std::abs(along[other] - along[v]) > reach) break;
      if ((positions.row(other) - positions.row(v)).norm() <= reach) return true;
    }
    return false;
  };
  int count = 0;
  for (std::ptrdiff_t i = 0; i < std::ssize(order); ++i) count += has_near(i, 1) || has_near(i, -1);
  return count;
}

std::string described_almost_welded(int places) {
  return std::to_string(places) + (places == 1 ? " place" : " places") +
         " of vertices within a millionth of the size of another, as where rounding opened seams: "
         "distances end there, and results come apart; give both copies one place";
}

MeshReport inspect(const Positions& positions, const Connectivity& connectivity) {
  if (positions.rows() != connectivity.vertices) {
    throw std::invalid_argument(std::to_string(positions.rows()) + " positions, expected " +
                                std::to_string(connectivity.vertices) + " as in the connectivity");
  }
  const Triangles& triangles = connectivity.triangles;
  const Weld weld = Weld::exact(positions);
  const Triangles welded = weld.welded(triangles);
  const EdgeCounts edges = count_edges(triangles);

  MeshReport report;
  report.vertices = connectivity.vertices;
  report.faces = connectivity.polygons.size();
  report.triangles = static_cast<int>(triangles.rows());
  report.components = components_with_triangle(report.vertices, triangles);
  report.components_after_welding = components_with_triangle(report.vertices, welded);
  report.boundary_edges = edges.boundary;
  report.boundary_edges_after_welding = count_edges(welded).boundary;
  report.nonmanifold_edges = edges.nonmanifold;
  // A triangle without area has no side.
  report.inconsistent_edges = count_edges(with_area(positions, triangles)).inconsistent;
  report.degenerate_triangles = degenerate_triangles(positions, triangles);
  report.vertices_without_face = vertices_without_face(report.vertices, triangles);
  report.welded_vertices = weld.count;
  report.almost_welded_vertices = almost_welded_vertices(positions, triangles);
  if (positions.rows() > 0) {
    report.extent = positions.colwise().maxCoeff() - positions.colwise().minCoeff();
  }
  return report;
}

std::vector<std::vector<int>> triangle_neighbors(int vertices, const Triangles& triangles) {
  check_indices(vertices, triangles);
  std::vector<std::vector<int>> neighbors(triangles.rows());
  for_each_edge(sorted_edges(triangles, Collapsed::kept), [&](auto first, auto last) {
    for (auto a = first; a != last; ++a) {
      for (auto b = first; b != last; ++b) {
        if (a != b) neighbors[a->triangle].push_back(b->triangle);
      }
    }
  });
  for (std::vector<int>& list : neighbors) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbors;
}

}  // namespace mimetra
