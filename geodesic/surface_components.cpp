#include "geodesic/surface_components.h"

#include <stdexcept>
#include <string>

#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/surface.h"

namespace mimetra::geodesic {
namespace {

void check_vertices(const Positions& positions, const Triangles& triangles) {
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

/// Reason why a triangle cannot be used; empty if it can.
std::string defect(const Positions& positions, const Triangles& triangles, Eigen::Index t) {
  const VertexIndex i = triangles(t, 0), j = triangles(t, 1), k = triangles(t, 2);
  if (i == j || j == k || k == i) return "repeats a vertex";
  return has_area(positions, triangles, t) ? "" : "has no area";
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

}  // namespace

SurfaceComponents::SurfaceComponents(const Positions& positions, const Triangles& triangles,
                                     Degenerate degenerate)
    : component_of(static_cast<std::size_t>(positions.rows()), -1), row_of(component_of) {
  check_vertices(positions, triangles);
  const Triangles usable = usable_triangles(positions, triangles, degenerate);
  degenerate_triangles = static_cast<int>(triangles.rows() - usable.rows());
  const auto vertices = static_cast<int>(positions.rows());
  const ConnectedComponents connected = connected_components(vertices, usable);
  std::vector<Eigen::Index> sizes(static_cast<std::size_t>(connected.count), 0);
  for (Eigen::Index t = 0; t < usable.rows(); ++t) ++sizes[connected.of_vertex[usable(t, 0)]];

  std::vector<int> number(sizes.size(), -1);  // of components with a triangle
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    const int label = connected.of_vertex[vertex];
    if (sizes[label] == 0) {
      vertices_without_face.push_back(vertex);
      continue;
    }
    if (number[label] < 0) {
      number[label] = static_cast<int>(components.size());
      components.emplace_back().triangles.resize(sizes[label], 3);
    }
    SurfaceComponent& component = components[number[label]];
    component_of[vertex] = number[label];
    row_of[vertex] = static_cast<VertexIndex>(component.vertices.size());
    component.vertices.push_back(vertex);
  }
  std::vector<Eigen::Index> placed(components.size(), 0);
  for (Eigen::Index t = 0; t < usable.rows(); ++t) {
    const int c = component_of[usable(t, 0)];
    for (int corner = 0; corner < 3; ++corner) {
      components[c].triangles(placed[c], corner) = row_of[usable(t, corner)];
    }
    ++placed[c];
  }
  for (SurfaceComponent& component : components) {
    component.positions = positions(component.vertices, Eigen::all);
    component.positions.rowwise() -= component.positions.colwise().mean().eval();
  }
}

std::vector<std::vector<VertexIndex>> SurfaceComponents::rows_of(
    std::span<const VertexIndex> sources) const {
  if (sources.empty()) throw std::invalid_argument("distances need at least one source vertex");
  const int vertices = static_cast<int>(component_of.size());
  std::vector<std::vector<VertexIndex>> rows(components.size());
  for (const VertexIndex source : sources) {
    if (source < 0 || source >= vertices) {
      throw std::out_of_range("source vertex " + std::to_string(source) + ", expected 0 to " +
                              std::to_string(vertices - 1));
    }
    if (component_of[source] >= 0) rows[component_of[source]].push_back(row_of[source]);
  }
  return rows;
}

}  // namespace mimetra::geodesic
