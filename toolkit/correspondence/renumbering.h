#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"

namespace mimetra {

/// Map between the vertices of two meshes that differ in their numbering, or the reason why there
/// is none.
struct Renumbering {
  /// Vertex of the other mesh for each vertex of the reference. Empty if there is no map or more
  /// than one.
  std::vector<VertexIndex> vertices;
  /// True if polygons of one mesh are split in the other, such as quads into triangles.
  bool splits = false;
  /// True if a vertex of one mesh is several coinciding vertices in the other, as along UV seams.
  /// `vertices` then contains the lowest of them.
  bool seams = false;
  /// Reason why `vertices` is empty.
  std::string why_not;

  bool found() const { return why_not.empty(); }
  /// Number of vertices of the reference that have another number in the other mesh.
  int moved() const;
  /// Text such as "the same faces, 572 vertices renumbered" or "the same faces but for polygons
  /// that one of them splits", or why_not.
  std::string summary() const;
};

/// Finds the map that makes the faces of `other` equal to the faces of `reference`. It tries three
/// ways in this order:
/// - The faces are equal one by one, each from the same first corner.
/// - The faces are equal one by one, each from some corner, and only one choice of corners fits.
/// - The faces are joined and bounded alike, in only one way. Connected oriented polygons have at
///   most one map for each image of one edge, so a mirror image does not count.
///
/// A mesh whose faces are oriented the opposite way is refused; why_not explains this. A polygon of
/// one mesh may be several successive faces of the other, which share their inner edges. Vertices
/// without a face are paired in ascending order.
Renumbering renumbering(const Connectivity& reference, const Connectivity& other);

/// Finds the map as above, and uses positions in three cases:
/// - A connected part has several maps, as eyeballs have. The map with the nearest vertices is
///   taken if every other map is at least twice as far (root mean square). Distances are measured
///   after the similarity of the other parts.
/// - The order of faces exchanges parts, so that one lies farther away than it is large. The map by
///   how faces are joined is taken instead if it does not do this.
/// - There is no map. Exactly coinciding vertices of both meshes are then welded.
///
/// Vertices without a face are paired in ascending order, each with the nearest one left. Throws
/// std::invalid_argument if a mesh does not have one finite position a vertex.
Renumbering renumbering(const TriMesh& reference, const TriMesh& other);

/// Frames and rest pose of a sequence on the vertices of another mesh, mapped while reading: vertex
/// v is vertices[v] of the source. Throws std::invalid_argument unless `vertices` has one source
/// vertex for each vertex of the connectivity.
std::shared_ptr<const FrameSource> renumbered(std::shared_ptr<const FrameSource> source,
                                              std::shared_ptr<const Connectivity> connectivity,
                                              std::vector<VertexIndex> vertices);

/// Values of a field on the vertices of another mesh. \pre the field is on vertices
Field renumbered(const Field& field, const std::vector<VertexIndex>& vertices);

}  // namespace mimetra
