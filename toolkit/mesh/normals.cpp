#include "toolkit/mesh/normals.h"

#include <Eigen/Geometry>

namespace mimetra {

Positions triangle_normals(const Eigen::Ref<const Positions>& positions,
                           const Triangles& triangles) {
  Positions normals(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)), b = positions.row(triangles(t, 1)),
                          c = positions.row(triangles(t, 2));
    normals.row(t) = (b - a).cross(c - a);
  }
  return normals;
}

Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles) {
  return vertex_normals(positions, triangles, Weld::none(static_cast<int>(positions.rows())));
}

Positions vertex_normals(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                         const Weld& weld) {
  const auto place = [&weld](VertexIndex v) {
    return weld.representative[static_cast<std::size_t>(v)];
  };
  const Positions of_triangles = triangle_normals(positions, triangles);
  Positions normals = Positions::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (const VertexIndex v : triangles.row(t)) normals.row(place(v)) += of_triangles.row(t);
  }
  for (VertexIndex v = 0; v < normals.rows(); ++v) normals.row(v) = normals.row(place(v));
  return normals;
}

}  // namespace mimetra
