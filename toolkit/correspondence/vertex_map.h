#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/tri_mesh.h"

/// Maps between the vertices of two meshes that have the same faces. Internal to renumbering().
namespace mimetra {

/// Kind of a face's side, by the faces beyond it.
enum class EdgeKind : std::uint8_t {
  inner,    ///< one other face with the same orientation
  border,   ///< no other face; also a side from a vertex to itself
  tangled,  ///< several other faces, or one with the opposite orientation
};

/// Polygons and their adjacency. Half-edge c leads from corner c of the polygons to the next corner
/// of the same polygon.
struct FaceGraph {
  /// Throws std::invalid_argument if a vertex is outside 0 .. `vertices` - 1. The message names the
  /// first such face.
  FaceGraph(int vertices, const Polygons& polygons);

  int size() const { return static_cast<int>(next.size()); }

  std::vector<VertexIndex> vertex;  ///< first vertex of each half-edge
  std::vector<int> face, next;
  std::vector<int> opposite;  ///< -1 except for inner edges
  std::vector<EdgeKind> kind;
};

/// Colours of the half-edges of two meshes by how faces are joined around them, at any distance.
/// Only half-edges of one colour can map to each other. Takes n log n steps.
///
/// [Hopcroft. An n log n algorithm for minimizing states in a finite automaton. Theory of Machines
/// and Computations, 1971]. Half-edges are the states, and the letters lead to the next half-edge
/// and to the opposite one.
struct Colours {
  Colours(const FaceGraph& a, const FaceGraph& b);

  int count = 0;                ///< colours are 0 to count - 1
  std::vector<int> of_a, of_b;  ///< colour of each half-edge
};

/// One of the two meshes in the search.
struct MapSide {
  const Polygons* polygons;
  int vertices;
  const Positions* positions;  ///< null if positions must not decide
};

/// Of two maps of one part, the nearer is taken if the other is this many times as far (root mean
/// square).
constexpr double kClearlyFarther = 2;

/// Similarity from `from` to `to`, fitted to the vertices with an image (-1: none). The identity if
/// they do not determine one.
Similarity told_by(const std::vector<VertexIndex>& image, const MapSide& from, const MapSide& to);

/// Image of each vertex if faces are equal corner by corner. Empty if they are not.
std::optional<std::vector<VertexIndex>> map_by_corners(const MapSide& from, const MapSide& to);

/// Image of each vertex if faces are equal one by one, each from some corner. Empty if there is no
/// such map, or several between which positions do not decide.
std::optional<std::vector<VertexIndex>> map_by_faces(const MapSide& from, const MapSide& to);

/// A map, or the reason why there is none.
struct FoundMap {
  std::vector<VertexIndex> vertices = {};
  std::string why_not = {};  ///< empty if there is a map
};

/// Map by how faces are joined and bounded. Positions decide between the maps of symmetric parts,
/// if they may.
FoundMap map_by_graph(const MapSide& from, const MapSide& to);

}  // namespace mimetra
