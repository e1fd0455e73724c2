#include "toolkit/mesh/triangle_quality.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace mimetra {

double triangle_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

bool has_area(const Positions& positions, const Triangles& triangles, Eigen::Index t) {
  const VertexIndex a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
  if (a == b || b == c || c == a) return false;
  return triangle_quality(positions.row(a), positions.row(b), positions.row(c)) >=
         kDegenerateQuality;
}

Triangles with_area(const Positions& positions, const Triangles& triangles) {
  std::vector<Eigen::Index> sound;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if (has_area(positions, triangles, t)) sound.push_back(t);
  }
  return triangles(sound, Eigen::all);
}

std::vector<VertexIndex> surface_vertices(const Positions& positions, const Triangles& triangles) {
  const Triangles sound = with_area(positions, triangles);
  return used_vertices(sound.rows() > 0 ? sound : triangles, positions.rows());
}

}  // namespace mimetra
