#include "toolkit/mesh/surface_parts.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "toolkit/mesh/inspection.h"

namespace mimetra {

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
  const ConnectedComponents connected = connected_components(vertices, weld.welded(triangles));
  const Eigen::VectorXd of_vertices = vertex_areas(positions, triangles);
  std::vector<int> of_vertex(vertices);
  std::vector<double> areas(connected.count, 0);
  for (VertexIndex v = 0; v < vertices; ++v) {
    of_vertex[v] = connected.of_vertex[weld.representative[v]];
    areas[of_vertex[v]] += of_vertices[v];
  }
  // A welded vertex leaves a label of its own behind, of which nothing is.
  std::vector<bool> used(connected.count, false);
  for (const int label : of_vertex) used[label] = true;
  std::vector<int> order;
  for (int label = 0; label < connected.count; ++label) {
    if (used[label]) order.push_back(label);
  }
  std::ranges::stable_sort(order, [&](int a, int b) { return areas[a] > areas[b]; });
  SurfaceParts parts;
  std::vector<int> rank(connected.count, -1);
  for (const int label : order) {
    rank[label] = parts.count();
    parts.areas.push_back(areas[label]);
  }
  for (const int label : of_vertex) parts.of_vertex.push_back(rank[label]);
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

Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(positions.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)), b = positions.row(triangles(t, 1)),
                          c = positions.row(triangles(t, 2));
    const double third = (b - a).cross(c - a).norm() / 6;
    for (int corner = 0; corner < 3; ++corner) areas[triangles(t, corner)] += third;
  }
  return areas;
}

}  // namespace mimetra
