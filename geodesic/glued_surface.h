#pragma once

#include <array>
#include <vector>

#include "geodesic/types.h"

namespace mimetra::geodesic {

/// Any set of triangles as an oriented manifold with borders, which is all that half-edge meshes
/// can hold: triangles are glued where exactly two share an edge, after turning those that run
/// the wrong way round. Edges of three triangles, the seam of a Moebius strip and vertices where
/// sheets touch stay open, and their vertices appear several times.
///
/// Half-edge 3 t + c runs from corner c of triangle t to the next corner.
struct GluedSurface {
  /// On `vertex`, M x 3, in the order of the input.
  Triangles triangles;
  /// The half-edge on the other side, -1 at a border (3M).
  std::vector<int> twin;
  /// Vertex of the input behind each vertex; the identity for a manifold.
  std::vector<VertexIndex> vertex;
};

/// \pre No triangle repeats a vertex, and each of the vertices 0 .. `vertices` - 1 has one.
GluedSurface glued(Eigen::Index vertices, const Triangles& triangles);

/// The half-edge before `halfedge` in its triangle.
inline int previous_in_triangle(int halfedge) {
  return halfedge % 3 == 0 ? halfedge + 2 : halfedge - 1;
}

/// The same surface in an OpenMesh kernel, vertices and faces in the same order. Edges are made
/// one by one, not by add_face, which refuses two edges between the same vertices.
template <typename Mesh>
Mesh mesh_of(const GluedSurface& surface, const Positions& positions) {
  Mesh mesh;
  for (const VertexIndex vertex : surface.vertex) {
    const auto row = positions.row(vertex);
    mesh.new_vertex(typename Mesh::Point(row[0], row[1], row[2]));
  }
  const auto vertex_handle = [&](int halfedge) {
    return typename Mesh::VertexHandle(surface.triangles(halfedge / 3, halfedge % 3));
  };
  const int halfedges = static_cast<int>(surface.twin.size());
  std::vector<typename Mesh::HalfedgeHandle> handles(halfedges);
  for (int h = 0; h < halfedges; ++h) {
    if (handles[h].is_valid()) continue;
    const int next = h % 3 == 2 ? h - 2 : h + 1;
    handles[h] = mesh.new_edge(vertex_handle(h), vertex_handle(next));
    if (surface.twin[h] >= 0) handles[surface.twin[h]] = mesh.opposite_halfedge_handle(handles[h]);
  }
  for (int h = 0; h < halfedges; h += 3) {
    const auto face = mesh.new_face();
    mesh.set_halfedge_handle(face, handles[h]);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.set_face_handle(handles[h + corner], face);
      mesh.set_next_halfedge_handle(handles[h + corner], handles[h + (corner + 1) % 3]);
      mesh.set_halfedge_handle(vertex_handle(h + corner), handles[h + corner]);
    }
  }
  for (int h = 0; h < halfedges; ++h) {
    if (surface.twin[h] >= 0) continue;
    // Turn about the vertex where h starts until the other border edge of its fan.
    int last = previous_in_triangle(h);
    while (surface.twin[last] >= 0) last = previous_in_triangle(surface.twin[last]);
    const auto border = mesh.opposite_halfedge_handle(handles[last]);
    mesh.set_next_halfedge_handle(mesh.opposite_halfedge_handle(handles[h]), border);
    // OpenMesh knows a border vertex by the half-edge that leaves it along the border.
    mesh.set_halfedge_handle(vertex_handle(h), border);
  }
  return mesh;
}

}  // namespace mimetra::geodesic
