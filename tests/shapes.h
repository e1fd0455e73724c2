#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>

#include "toolkit/mesh/tri_mesh.h"

/// Meshes whose mathematics is known.
namespace mimetra::test {

struct Shape {
  Positions positions;
  Triangles triangles;
};

/// Flat grid of columns x rows vertices with unit spacing in z = 0, row by row.
inline Shape grid(int columns, int rows) {
  Shape shape{Positions(columns * rows, 3), Triangles(2 * (columns - 1) * (rows - 1), 3)};
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) shape.positions.row(y * columns + x) << x, y, 0;
  }
  int t = 0;
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      const int a = y * columns + x, b = a + 1, c = a + columns, d = c + 1;
      shape.triangles.row(t++) << a, b, d;
      shape.triangles.row(t++) << a, d, c;
    }
  }
  return shape;
}

inline Shape octahedron() {
  Shape shape{Positions(6, 3), Triangles(8, 3)};
  shape.positions << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  shape.triangles << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  return shape;
}

/// Each triangle split in four at its edge midpoints; old vertices come first.
inline Shape subdivided(const Shape& coarse) {
  std::map<std::pair<int, int>, int> midpoints;
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(coarse.positions.rows()));
  for (int v = 0; v < coarse.positions.rows(); ++v) points.push_back(coarse.positions.row(v));
  const auto midpoint = [&](int a, int b) {
    const auto [entry, added] =
        midpoints.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(points.size()));
    if (added) points.push_back((points[a] + points[b]) / 2);
    return entry->second;
  };
  Shape fine{{}, Triangles(4 * coarse.triangles.rows(), 3)};
  for (int t = 0; t < coarse.triangles.rows(); ++t) {
    const int a = coarse.triangles(t, 0), b = coarse.triangles(t, 1), c = coarse.triangles(t, 2);
    const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    fine.triangles.row(4 * t) << a, ab, ca;
    fine.triangles.row(4 * t + 1) << ab, b, bc;
    fine.triangles.row(4 * t + 2) << ca, bc, c;
    fine.triangles.row(4 * t + 3) << ab, bc, ca;
  }
  fine.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) fine.positions.row(v) = points[v];
  return fine;
}

/// Unit sphere: an octahedron subdivided `levels` times (4^levels x 8 triangles).
inline Shape sphere(int levels) {
  Shape shape = octahedron();
  for (int level = 0; level < levels; ++level) {
    shape = subdivided(shape);
    shape.positions.rowwise().normalize();
  }
  return shape;
}

/// Two shapes as one mesh; the second one's vertices follow the first one's.
inline Shape both(const Shape& a, const Shape& b) {
  Shape shape{Positions(a.positions.rows() + b.positions.rows(), 3),
              Triangles(a.triangles.rows() + b.triangles.rows(), 3)};
  shape.positions << a.positions, b.positions;
  shape.triangles << a.triangles,
      (b.triangles.array() + static_cast<int>(a.positions.rows())).matrix();
  return shape;
}

inline Triangles triangles_of(std::initializer_list<std::array<int, 3>> list) {
  Triangles triangles(static_cast<Eigen::Index>(list.size()), 3);
  int t = 0;
  for (const auto& [a, b, c] : list) triangles.row(t++) << a, b, c;
  return triangles;
}

inline TriMesh mesh_of(const Shape& shape) {
  return {shape.positions,
          Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles)};
}

}  // namespace mimetra::test
