#pragma once

#include <map>
#include <span>
#include <vector>

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Faces that have a vertex twice.
enum class Collapsed { left_out, kept };

/// The sides of a mesh's faces, by their edges. Corners are counted face after face, so that number
/// c of triangle t is 3 t + c; a side is named by the corner that it starts from, and ends at the
/// face's next one.
class EdgeSides {
 public:
  /// Collapsed faces that are kept have sides but for those from a vertex to itself.
  ///
  /// Throws std::invalid_argument that names the first face with a vertex outside 0 ..
  /// `vertices` - 1. \pre offsets of polygons are those of Connectivity::from_polygons()
  EdgeSides(int vertices, const Triangles& triangles, Collapsed collapsed = Collapsed::left_out);
  EdgeSides(int vertices, const Polygons& polygons, Collapsed collapsed = Collapsed::left_out);

  /// Calls `visit` for each edge, by its lower, then by its higher vertex, with all its sides: a
  /// std::span<const int>, ascending.
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

  std::vector<int> sides_;          // edge by edge
  std::vector<int> first_of_edge_;  // and the end
};

/// The connectivity of any mesh as OpenMesh half-edges, to walk along.
///
/// Half-edges hold oriented manifolds only. Faces are neighbours where exactly two share an edge;
/// one that is wound against its neighbours is turned. Elsewhere the surface is open: at edges of
/// three and more faces, along the seam of a Moebius strip, and where sheets touch in a vertex.
/// Such a vertex has a copy for each sheet, so that every vertex of the half-edges has one fan of
/// faces.
///
/// Vertices and faces keep their numbers; copies follow behind the given vertices.
class Surface {
 public:
  using HalfEdges = OpenMesh::PolyConnectivity;

  /// Throws std::invalid_argument as EdgeSides.
  Surface(int vertices, const Triangles& triangles);
  Surface(int vertices, const Polygons& polygons);
  /// On the vertices that stand for welded ones; the others have no faces.
  Surface(const Triangles& triangles, const Weld& weld);

  /// Faces that are left out are marked as deleted, so that faces() passes over them. The half-edge
  /// of a face leads from its first corner.
  const HalfEdges& half_edges() const { return half_edges_; }

  /// Vertices as given (N).
  int vertices() const { return vertices_; }
  /// The given vertex behind one of the half-edges' vertices.
  VertexIndex vertex_of(OpenMesh::VertexHandle vertex) const;
  /// Those that stand for a given vertex, itself first: one unless sheets touch there.
  std::vector<OpenMesh::VertexHandle> copies_of(VertexIndex vertex) const;
  /// How many copies follow behind the given vertices.
  int copies() const { return static_cast<int>(copied_.size()); }

  /// Faces that have a vertex twice, ascending.
  const std::vector<int>& left_out() const { return left_out_; }
  /// Faces that run the other way round than given, ascending; the lowest face of those that are
  /// neighbours never does.
  const std::vector<int>& turned() const { return turned_; }

  /// Given vertices that an edge joins with a vertex, ascending.
  std::vector<VertexIndex> neighbors(VertexIndex vertex) const;

 private:
  Surface(int vertices, std::vector<VertexIndex> corners, std::vector<int> offsets);

  int vertices_;
  HalfEdges half_edges_;
  std::vector<VertexIndex> copied_;  // the given vertex of each copy, ascending
  std::vector<int> left_out_, turned_;
};

/// Vertices that edges lead to within `reach` (length) of the nearest of `from`, and how far.
/// `positions` N x 3. An edge on the way is no farther from the surface's own distance than its
/// triangles are long.
std::map<VertexIndex, double> within_reach(const Surface& surface, const Positions& positions,
                                           double reach, const std::vector<VertexIndex>& from);

/// Length of the longest edge of a vertex; 0 without any.
double longest_edge(const Surface& surface, const Positions& positions, VertexIndex vertex);

/// Parts that hang together by vertices of faces: labels 0, 1, ... in the order of each one's
/// lowest vertex. A vertex without face is a part of its own.
struct ConnectedComponents {
  int count = 0;
  std::vector<int> of_vertex;
};

/// Throws std::invalid_argument as EdgeSides.
ConnectedComponents connected_components(int vertices, const Triangles& triangles);
/// The same where welded vertices are one.
ConnectedComponents connected_components(const Triangles& triangles, const Weld& weld);

}  // namespace mimetra
