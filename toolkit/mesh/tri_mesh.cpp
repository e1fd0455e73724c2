#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

void check_polygons(int vertices, const Polygons& polygons) {
  if (polygons.offsets.empty() || polygons.offsets.front() != 0 ||
      polygons.offsets.back() != static_cast<int>(polygons.corners.size()) ||
      !std::is_sorted(polygons.offsets.begin(), polygons.offsets.end())) {
    throw std::invalid_argument("polygon offsets must rise from 0 to the number of corners, " +
                                std::to_string(polygons.corners.size()));
  }
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face], last = polygons.offsets[face + 1];
    if (last - first < 3) {
      throw std::invalid_argument("face " + std::to_string(face) + " has " +
                                  std::to_string(last - first) + " corners, expected at least 3");
    }
    for (int corner = first; corner < last; ++corner) {
      const int vertex = polygons.corners[corner];
      if (vertex < 0 || vertex >= vertices) {
        throw std::invalid_argument("face " + std::to_string(face) + " uses vertex " +
                                    std::to_string(vertex) + ", expected 0 to " +
                                    std::to_string(vertices - 1));
      }
    }
  }
}

bool same_up_to_rotation(const int* a, const int* b, int corners) {
  for (int shift = 0; shift < corners; ++shift) {
    if (std::equal(a + shift, a + corners, b) && std::equal(a, a + shift, b + corners - shift)) {
      return true;
    }
  }
  return corners == 0;
}

bool same_face(const Polygons& a, const Polygons& b, int face) {
  const int corners = a.offsets[face + 1] - a.offsets[face];
  if (corners != b.offsets[face + 1] - b.offsets[face]) return false;
  return same_up_to_rotation(a.corners.data() + a.offsets[face], b.corners.data() + b.offsets[face],
                             corners);
}

Eigen::Vector3d box_sides(const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() == 0) return Eigen::Vector3d::Zero();
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).transpose();
}

}  // namespace

Connectivity Connectivity::from_polygons(int vertices, Polygons polygons) {
  check_polygons(vertices, polygons);
  Connectivity result;
  result.vertices = vertices;
  // A polygon of c corners gives c - 2 triangles.
  const auto triangles = static_cast<int>(polygons.corners.size()) - 2 * polygons.size();
  result.triangles.resize(triangles, 3);
  result.polygon_of_triangle.reserve(triangles);
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face];
    for (int corner = first + 1; corner + 1 < polygons.offsets[face + 1]; ++corner) {
      result.triangles.row(static_cast<int>(result.polygon_of_triangle.size()))
          << polygons.corners[first],
          polygons.corners[corner], polygons.corners[corner + 1];
      result.polygon_of_triangle.push_back(face);
    }
  }
  result.polygons = std::move(polygons);
  return result;
}

Connectivity Connectivity::from_triangles(int vertices, const Triangles& triangles) {
  Polygons polygons;
  polygons.corners.assign(triangles.data(), triangles.data() + triangles.size());
  polygons.offsets.resize(triangles.rows() + 1);
  for (std::size_t face = 0; face < polygons.offsets.size(); ++face) {
    polygons.offsets[face] = static_cast<int>(3 * face);
  }
  return from_polygons(vertices, std::move(polygons));
}

bool same_faces(const Connectivity& a, const Connectivity& b) {
  return a.vertices == b.vertices && first_different_face(a, b) == -1;
}

int first_different_face(const Connectivity& a, const Connectivity& b) {
  const int common = std::min(a.polygons.size(), b.polygons.size());
  for (int face = 0; face < common; ++face) {
    if (!same_face(a.polygons, b.polygons, face)) return face;
  }
  return a.polygons.size() == b.polygons.size() ? -1 : common;
}

std::vector<VertexIndex> used_vertices(const Triangles& triangles, Eigen::Index vertices) {
  std::vector<bool> is_used(static_cast<std::size_t>(vertices), triangles.rows() == 0);
  for (const VertexIndex vertex : triangles.reshaped()) is_used[vertex] = true;
  std::vector<VertexIndex> used;
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (is_used[v]) used.push_back(v);
  }
  return used;
}

double extent(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).maxCoeff();
}

double box_diagonal(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).norm();
}

}  // namespace mimetra
