#pragma once

#include <stdexcept>
#include <string>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Positions and triangles of any OpenMesh triangle mesh; vertex and face order stay as they are.
/// Throws std::invalid_argument where the mesh has deleted elements (call garbage_collection
/// first).
template <typename Traits>
TriMesh from_openmesh(const OpenMesh::TriMesh_ArrayKernelT<Traits>& mesh);

/// The same mesh, with all its properties, at new positions (N x 3, in its vertex order). Throws
/// std::invalid_argument where the count differs from the mesh's vertices.
template <typename Traits>
OpenMesh::TriMesh_ArrayKernelT<Traits> with_positions(OpenMesh::TriMesh_ArrayKernelT<Traits> mesh,
                                                      const Eigen::Ref<const Positions>& positions);

// ---- implementation ----

template <typename Traits>
TriMesh from_openmesh(const OpenMesh::TriMesh_ArrayKernelT<Traits>& mesh) {
  const int vertices = static_cast<int>(mesh.n_vertices());
  const int faces = static_cast<int>(mesh.n_faces());
  const auto deleted = [&mesh](auto handle, bool has_status) {
    return has_status && mesh.status(handle).deleted();
  };
  TriMesh result;
  result.positions.resize(vertices, 3);
  for (const auto vertex : mesh.all_vertices()) {
    if (deleted(vertex, mesh.has_vertex_status())) {
      throw std::invalid_argument("vertex " + std::to_string(vertex.idx()) +
                                  " is deleted; call garbage_collection() first");
    }
    const auto& point = mesh.point(vertex);
    for (int axis = 0; axis < 3; ++axis) result.positions(vertex.idx(), axis) = point[axis];
  }
  Triangles triangles(faces, 3);
  for (const auto face : mesh.all_faces()) {
    if (deleted(face, mesh.has_face_status())) {
      throw std::invalid_argument("face " + std::to_string(face.idx()) +
                                  " is deleted; call garbage_collection() first");
    }
    int corner = 0;
    for (const auto vertex : mesh.fv_range(face)) triangles(face.idx(), corner++) = vertex.idx();
  }
  result.connectivity = Connectivity::from_triangles(vertices, triangles);
  return result;
}

template <typename Traits>
OpenMesh::TriMesh_ArrayKernelT<Traits> with_positions(
    OpenMesh::TriMesh_ArrayKernelT<Traits> mesh, const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() != static_cast<Eigen::Index>(mesh.n_vertices())) {
    throw std::invalid_argument(std::to_string(positions.rows()) + " positions for a mesh of " +
                                std::to_string(mesh.n_vertices()) + " vertices");
  }
  using Point = typename OpenMesh::TriMesh_ArrayKernelT<Traits>::Point;
  using Scalar = typename OpenMesh::vector_traits<Point>::value_type;
  for (const auto vertex : mesh.all_vertices()) {
    const auto row = positions.row(vertex.idx());
    mesh.set_point(vertex, Point(static_cast<Scalar>(row[0]), static_cast<Scalar>(row[1]),
                                 static_cast<Scalar>(row[2])));
  }
  return mesh;
}

}  // namespace mimetra
