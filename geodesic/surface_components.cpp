#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "geodesic/surface_components.h"

namespace mimetra::geodesic {
namespace {

/// Below this quality 2 A / l_max^2 a triangle is degenerate. The intrinsic Delaunay flips know a
/// triangle by its edge lengths alone, where its height shows up as a relative excess of about
/// quality^2: at 1e-6 that is 1e-12, still four digits above rounding; at 1e-8 nothing is left and
/// the flips need not end. Faces of real meshes go down to 4e-3.
constexpr double kDegenerateQuality = 1e-6;

void check_indices(const Positions& positions, const Triangles& triangles) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (const VertexIndex vertex : triangles.row(t)) {
      const std::string name =
          "triangle " + std::to_string(t) + " uses vertex " + std::to_string(vertex);
      if (vertex < 0 || vertex >= positions.rows()) {
        throw std::invalid_argument(name + ", expected 0 to " +
                                    std::to_string(positions.rows() - 1));
      }
      if (!positions.row(vertex).allFinite()) {
        throw std::invalid_argument(name + ", whose position is not finite; repair the mesh");
      }
    }
  }
}

/// Why the triangle cannot be used; empty where it can.
std::string defect(const Positions& positions, const Triangles& triangles, Eigen::Index t) {
  const VertexIndex i = triangles(t, 0), j = triangles(t, 1), k = triangles(t, 2);
  if (i == j || j == k || k == i) return "repeats a vertex";
  const Eigen::Vector3d a = positions.row(j) - positions.row(i);
  const Eigen::Vector3d b = positions.row(k) - positions.row(i);
  const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  const bool usable = a.cross(b).norm() >= kDegenerateQuality * longest * longest && longest > 0;
  return usable ? "" : "has no area";
}

Triangles usable_triangles(const Positions& positions, const Triangles& triangles,
                           Degenerate degenerate) {
  Triangles usable(triangles.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const std::string why = defect(positions, triangles, t);
    if (why.empty()) {
      usable.row(count++) = triangles.row(t);
    } else if (degenerate == Degenerate::refused) {
      throw std::invalid_argument(
          "triangle " + std::to_string(t) + " (vertices " + std::to_string(triangles(t, 0)) + ", " +
          std::to_string(triangles(t, 1)) + ", " + std::to_string(triangles(t, 2)) + ") " + why +
          "; remove it or allow degenerate triangles to be left out");
    }
  }
  usable.conservativeResize(count, 3);
  return usable;
}

/// Lowest vertex that is connected with each vertex.
std::vector<VertexIndex> lowest_connected(Eigen::Index vertices, const Triangles& triangles) {
  std::vector<VertexIndex> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](VertexIndex vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (const int corner : {1, 2}) {
      const auto [low, high] = std::minmax({root(triangles(t, 0)), root(triangles(t, corner))});
      parent[high] = low;
    }
  }
  for (VertexIndex& vertex : parent) vertex = root(vertex);
  return parent;
}

/// Fills component_of, row_of, vertices_without_face and the vertices of each component.
void number_vertices(SurfaceComponents& surface, Eigen::Index vertices,
                     const Triangles& triangles) {
  std::vector<char> used(vertices, 0);
  for (const VertexIndex vertex : triangles.reshaped()) used[vertex] = 1;
  const std::vector<VertexIndex> lowest = lowest_connected(vertices, triangles);
  surface.component_of.assign(vertices, -1);
  surface.row_of.assign(vertices, -1);
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    if (!used[vertex]) {
      surface.vertices_without_face.push_back(vertex);
      continue;
    }
    if (lowest[vertex] == vertex) surface.components.emplace_back();
    const int component = lowest[vertex] == vertex ? static_cast<int>(surface.components.size()) - 1
                                                   : surface.component_of[lowest[vertex]];
    auto& members = surface.components[component].vertices;
    surface.component_of[vertex] = component;
    surface.row_of[vertex] = static_cast<VertexIndex>(members.size());
    members.push_back(vertex);
  }
}

void place_triangles(SurfaceComponents& surface, const Triangles& triangles) {
  std::vector<Eigen::Index> counts(surface.components.size(), 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    ++counts[surface.component_of[triangles(t, 0)]];
  }
  for (std::size_t c = 0; c < counts.size(); ++c) {
    surface.components[c].triangles.resize(counts[c], 3);
    counts[c] = 0;
  }
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int c = surface.component_of[triangles(t, 0)];
    auto row = surface.components[c].triangles.row(counts[c]++);
    for (int corner = 0; corner < 3; ++corner) row[corner] = surface.row_of[triangles(t, corner)];
  }
}

}  // namespace

SurfaceComponents surface_components(const Positions& positions, const Triangles& triangles,
                                     Degenerate degenerate) {
  check_indices(positions, triangles);
  const Triangles usable = usable_triangles(positions, triangles, degenerate);
  SurfaceComponents surface;
  surface.degenerate_triangles = static_cast<int>(triangles.rows() - usable.rows());
  number_vertices(surface, positions.rows(), usable);
  place_triangles(surface, usable);
  for (SurfaceComponent& component : surface.components) {
    component.positions = positions(component.vertices, Eigen::all);
    component.positions.rowwise() -= component.positions.colwise().mean().eval();
  }
  return surface;
}

std::vector<std::vector<VertexIndex>> sources_by_component(const SurfaceComponents& surface,
                                                           std::span<const VertexIndex> sources) {
  if (sources.empty()) throw std::invalid_argument("distances need at least one source vertex");
  const int vertices = static_cast<int>(surface.component_of.size());
  std::vector<std::vector<VertexIndex>> rows(surface.components.size());
  for (const VertexIndex source : sources) {
    if (source < 0 || source >= vertices) {
      throw std::out_of_range("source vertex " + std::to_string(source) + ", expected 0 to " +
                              std::to_string(vertices - 1));
    }
    if (surface.component_of[source] >= 0) {
      rows[surface.component_of[source]].push_back(surface.row_of[source]);
    }
  }
  return rows;
}

}  // namespace mimetra::geodesic
