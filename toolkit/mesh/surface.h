#pragma once

#include <map>
#include <span>
#include <vector>

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Treatment of faces that repeat a vertex.
enum class Collapsed { left_out, kept };

/// Sides of a mesh's faces, grouped by edge.
///
/// Corners are counted face after face, so that corner c of triangle t has number 3 t + c. A side
/// has the number of the corner where it starts; it ends at the face's next corner.
class EdgeSides {
 public:
  /// If collapsed faces are kept, they have all sides except those from a vertex to itself.
  ///
  /// Throws std::invalid_argument if a vertex is outside 0 .. `vertices` - 1; the message names the
  /// first such face. \pre offsets of polygons are as in Connectivity::from_polygons()
  EdgeSides(int vertices, const Triangles& triangles, Collapsed collapsed = Collapsed::left_out);
  EdgeSides(int vertices, const Polygons& polygons, Collapsed collapsed = Collapsed::left_out);

  /// Calls `visit` for each edge with all its sides, a std::span<const int> in ascending order.
  /// Edges are sorted by their lower vertex, then by their higher vertex.
  template <typename Visit>
  void for_each_edge(Visit visit) const {
    for (std::size_t e = 0; e + 1 < first_of_edge_.size(); ++e) {
      const auto first = static_cast<std::size_t>(first_of_edge_[e]);
      visit(std::span(sides_).subspan(first,
                                      static_cast<std::size_t>(first_of_edge_[e + 1]) - first));
    }
  }

 private:
  friend class Surface;
  EdgeSides(int vertices, std::span<const VertexIndex> corners, const std::vector<int>& offsets,
            const std::vector<int>& left_out);

  std::vector<int> sides_;          // grouped by edge
  std::vector<int> first_of_edge_;  // index of each edge's first side, and the end
};

/// Connectivity of any mesh as OpenMesh half-edges.
///
/// Half-edges represent only oriented manifolds. Faces are neighbours if exactly two share an edge;
/// a face that is wound against its neighbours is turned. The surface is open at edges of three or
/// more faces and along the seam of a Moebius strip. It is also open where sheets touch in a
/// vertex. Such a vertex has a copy for each further sheet, so that each vertex of the half-edges
/// has one fan of faces.
///
/// Vertices and faces keep their numbers; copies follow the given vertices.
class Surface {
 public:
  using HalfEdges = OpenMesh::PolyConnectivity;

  /// Throws std::invalid_argument as EdgeSides.
  Surface(int vertices, const Triangles& triangles);
  Surface(int vertices, const Polygons& polygons);
  /// Uses the representatives of welded vertices; the other vertices have no faces.
  Surface(const Triangles& triangles, const Weld& weld);

  /// Half-edges of the surface. Left-out faces are marked as deleted, so that faces() skips them.
  /// The half-edge of a face starts at its first corner.
  const HalfEdges& half_edges() const { return half_edges_; }

  /// Number of given vertices (N), without copies.
  int vertices() const { return vertices_; }
  /// Given vertex of a vertex of the half-edges.
  VertexIndex vertex_of(OpenMesh::VertexHandle vertex) const;
  /// Vertices of the half-edges for a given vertex, itself first; one unless sheets touch there.
  std::vector<OpenMesh::VertexHandle> copies_of(VertexIndex vertex) const;
  /// Number of copies after the given vertices.
  int copies() const { return static_cast<int>(copied_.size()); }

  /// Faces that repeat a vertex, ascending.
  const std::vector<int>& left_out() const { return left_out_; }
  /// Faces that are turned against their given winding, ascending. Of faces connected through
  /// neighbours, the lowest is never turned.
  const std::vector<int>& turned() const { return turned_; }

  /// Given vertices that share an edge with `vertex`, ascending.
  std::vector<VertexIndex> neighbors(VertexIndex vertex) const;

 private:
  Surface(int vertices, std::vector<VertexIndex> corners, std::vector<int> offsets);

  int vertices_;
  HalfEdges half_edges_;
  std::vector<VertexIndex> copied_;  // given vertex of each copy, ascending
  std::vector<int> left_out_, turned_;
};

/// Vertices within `reach` (length) along edges of the nearest vertex of `from`, with their
/// distances. `positions` is N x 3. Distances along edges are upper bounds of distances on the
/// surface.
std::map<VertexIndex, double> within_reach(const Surface& surface, const Positions& positions,
                                           double reach, const std::vector<VertexIndex>& from);

/// Length of a vertex's longest edge; 0 without edges.
double longest_edge(const Surface& surface, const Positions& positions, VertexIndex vertex);

/// Parts that are connected through vertices of faces. Labels 0, 1, ... follow the lowest vertex of
/// each part. A vertex without a face is a part of its own.
struct ConnectedComponents {
  int count = 0;
  std::vector<int> of_vertex;
};

/// Throws std::invalid_argument as EdgeSides.
ConnectedComponents connected_components(int vertices, const Triangles& triangles);
/// Components after welding: welded vertices count as one.
ConnectedComponents connected_components(const Triangles& triangles, const Weld& weld);

}  // namespace mimetra
