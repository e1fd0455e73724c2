#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"

namespace mimetra {

/// How the vertices of one mesh are those of another that is numbered differently, or why they are
/// not.
struct Renumbering {
  /// Vertex of the other mesh for each one of the reference; empty where there is no map, or more
  /// than one.
  std::vector<VertexIndex> vertices;
  /// Polygons of one are split in the other: quads and their triangles.
  bool splits = false;
  /// Vertices of one are several at the same place in the other: UV seams. A vertex of the
  /// reference is then the lowest of those it is in the other.
  bool seams = false;
  /// Why `vertices` is empty.
  std::string why_not;

  bool found() const { return why_not.empty(); }
  /// Vertices of the reference that have another number in the other mesh.
  int moved() const;
  /// "the same faces, 572 vertices renumbered", "the same faces but for polygons that one of them
  /// splits", or why not.
  std::string summary() const;
};

/// The map that makes the faces of `other` those of `reference`. In this order, the first that
/// holds:
/// - the faces are the same one by one, each from the same first corner;
/// - they are the same one by one, each from some corner, and only one choice of them fits;
/// - faces are joined and bounded alike, in one way only. Oriented polygons that hang together have
///   at most one map for each image of one edge, so that no mirror image counts.
/// A mesh whose faces lead the other way round is refused, and said to be so.
/// Polygons of one may be several successive faces of the other (they share their inner edges).
/// Vertices without a face are paired in ascending order, since nothing tells them apart here.
Renumbering renumbering(const Connectivity& reference, const Connectivity& other);

/// The same where positions may decide, for faces in three cases only: of several maps of a
/// connected part, as eyeballs have, the one whose vertices are nearest (after the similarity that
/// the other parts tell) is taken where every other map is at least twice as far (root mean
/// square); where the order of faces exchanges parts, so that one lies farther away than it is
/// large, the map by how faces are joined is taken if it does not; and where there is no map,
/// vertices at exactly one place are taken for one in both meshes. Vertices without a face are
/// paired in ascending order, each with the nearest one left. Throws
/// std::invalid_argument where a mesh has not a position for each vertex, or one that is not
/// finite.
Renumbering renumbering(const TriMesh& reference, const TriMesh& other);

/// The frames and the rest pose of a sequence as vertices of another mesh, carried when they are
/// read: vertex v is vertices[v] of the source. Throws std::invalid_argument unless there is one of
/// them for each vertex of the connectivity.
std::shared_ptr<const FrameSource> renumbered(std::shared_ptr<const FrameSource> source,
                                              std::shared_ptr<const Connectivity> connectivity,
                                              std::vector<VertexIndex> vertices);

/// The values of a field of the vertices, likewise. \pre of the vertices
Field renumbered(const Field& field, const std::vector<VertexIndex>& vertices);

}  // namespace mimetra
