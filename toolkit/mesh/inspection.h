#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/measures.h"

namespace mimetra {

/// What a mesh is made of. Indices and counts are those of the mesh as given, before welding.
struct MeshReport {
  int vertices = 0;
  int faces = 0;
  int triangles = 0;
  /// Components that hold a triangle.
  int components = 0;
  int components_after_welding = 0;
  int boundary_edges = 0;
  int boundary_edges_after_welding = 0;
  /// Edges of more than two triangles.
  int nonmanifold_edges = 0;
  /// Edges of two triangles with_area() that are wound against each other: the faces of one side
  /// are turned.
  int inconsistent_edges = 0;
  /// Triangles that repeat a vertex or are degenerate by `triangle_quality`.
  std::vector<int> degenerate_triangles;
  std::vector<VertexIndex> vertices_without_face;
  /// Vertices that coincide with an earlier one.
  int welded_vertices = 0;
  /// Places of vertices within a millionth of the box's diagonal of another: seams that rounding
  /// opened.
  int almost_welded_vertices = 0;
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();
};

/// MeshReport::almost_welded_vertices. Throws std::invalid_argument that names a vertex which is
/// not finite.
int almost_welded_vertices(const Positions& positions, const Triangles& triangles);

/// What that many mean to a person; not for 0.
std::string described_almost_welded(int places);

MeshReport inspect(const Positions& positions, const Connectivity& connectivity);

/// Neighbours of each triangle across its edges, at most a few each; lists ascend.
std::vector<std::vector<int>> triangle_neighbors(int vertices, const Triangles& triangles);

}  // namespace mimetra
