#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

struct EdgeCounts {
  int boundary = 0;
  int nonmanifold = 0;
  int inconsistent = 0;
};

EdgeCounts count_edges(int vertices, const Triangles& triangles) {
  EdgeCounts counts;
  const auto from = [&triangles](int corner) { return triangles(corner / 3, corner % 3); };
  EdgeSides(vertices, triangles).for_each_edge([&](std::span<const int> sides) {
    if (sides.size() == 1) ++counts.boundary;
    if (sides.size() > 2) ++counts.nonmanifold;
    if (sides.size() == 2 && from(sides[0]) == from(sides[1])) ++counts.inconsistent;
  });
  return counts;
}

int components_with_triangle(const Triangles& triangles, const Weld& weld) {
  const ConnectedComponents components = connected_components(triangles, weld);
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

int almost_welded_vertices(const Positions& positions, const Triangles& triangles) {
  const Weld weld = Weld::exact(positions);
  constexpr double kAlmost = 1e-6;
  const double reach = kAlmost * diameter(positions, triangles);
  // Along a direction that is not aligned with any grid.
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
  const EdgeCounts edges = count_edges(connectivity.vertices, triangles);
  const std::vector<int> degenerate = degenerate_triangles(positions, triangles);

  MeshReport report;
  report.vertices = connectivity.vertices;
  report.faces = connectivity.polygons.size();
  report.triangles = static_cast<int>(triangles.rows());
  report.components = components_with_triangle(triangles, Weld::none(report.vertices));
  report.components_after_welding = components_with_triangle(triangles, weld);
  report.boundary_edges = edges.boundary;
  report.boundary_edges_after_welding =
      weld.count == 0 ? edges.boundary
                      : count_edges(report.vertices, weld.welded(triangles)).boundary;
  report.nonmanifold_edges = edges.nonmanifold;
  // A triangle without area has no orientation.
  report.inconsistent_edges =
      degenerate.empty()
          ? edges.inconsistent
          : count_edges(report.vertices, with_area(positions, triangles)).inconsistent;
  report.degenerate_triangles = degenerate;
  report.vertices_without_face = vertices_without_face(report.vertices, triangles);
  report.welded_vertices = weld.count;
  report.almost_welded_vertices = almost_welded_vertices(positions, triangles);
  if (positions.rows() > 0) {
    report.extent = positions.colwise().maxCoeff() - positions.colwise().minCoeff();
  }
  return report;
}

std::vector<std::vector<int>> triangle_neighbors(int vertices, const Triangles& triangles) {
  std::vector<std::vector<int>> neighbors(triangles.rows());
  const EdgeSides edges(vertices, triangles, Collapsed::kept);
  edges.for_each_edge([&](std::span<const int> sides) {
    for (const int a : sides) {
      for (const int b : sides) {
        if (a / 3 != b / 3) neighbors[a / 3].push_back(b / 3);
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
