#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/measures.h"

namespace mimetra {

/// Composition and defects of a mesh. Indices and counts refer to the mesh before welding, except
/// where noted.
struct MeshReport {
  int vertices = 0;
  int faces = 0;
  int triangles = 0;
  /// Components with at least one triangle.
  int components = 0;
  int components_after_welding = 0;
  int boundary_edges = 0;
  int boundary_edges_after_welding = 0;
  /// Edges with more than two triangles.
  int nonmanifold_edges = 0;
  /// Edges of two triangles with_area() that are wound against each other: one side of the edge has
  /// turned faces.
  int inconsistent_edges = 0;
  /// Triangles that repeat a vertex or have a triangle_quality() below kDegenerateQuality.
  std::vector<int> degenerate_triangles;
  std::vector<VertexIndex> vertices_without_face;
  /// Vertices that coincide with an earlier one.
  int welded_vertices = 0;
  /// Places of vertices within a millionth of the diameter of another place: seams that rounding
  /// opened.
  int almost_welded_vertices = 0;
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();
};

/// Computes MeshReport::almost_welded_vertices. Throws std::invalid_argument if a vertex is not
/// finite; the message names it.
int almost_welded_vertices(const Positions& positions, const Triangles& triangles);

/// Explanation of almost welded vertices for users. \pre places > 0
std::string described_almost_welded(int places);

MeshReport inspect(const Positions& positions, const Connectivity& connectivity);

/// Neighbours of each triangle across its edges, in ascending lists.
std::vector<std::vector<int>> triangle_neighbors(int vertices, const Triangles& triangles);

}  // namespace mimetra
