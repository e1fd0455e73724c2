#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/tri_mesh.h"

/// Maps of the vertices of one mesh onto those of another that has the same faces. Internal to
/// renumbering().
namespace mimetra {

/// What lies beyond a side of a face.
enum class EdgeKind : std::uint8_t {
  inner,    ///< one other face, oriented alike
  border,   ///< nothing; also for a side from a vertex to itself
  tangled,  ///< more than one other face, or one oriented the other way
};

/// Polygons as they are given, and how they are joined. The half-edge c of a mesh leads from corner
/// c of its polygons to the next corner of that polygon.
struct FaceGraph {
  /// Throws std::invalid_argument that names the first face with a vertex outside 0 ..
  /// `vertices` - 1.
  FaceGraph(int vertices, const Polygons& polygons);

  int size() const { return static_cast<int>(next.size()); }

  std::vector<VertexIndex> vertex;  ///< where each half-edge begins
  std::vector<int> face, next;
  std::vector<int> opposite;  ///< -1 but for inner edges
  std::vector<EdgeKind> kind;
};

/// Colours of the half-edges of two meshes by how faces are joined around them, however far away:
/// half-edges of one colour may be each other's image, others cannot. Takes n log n steps.
///
/// [Hopcroft. An n log n algorithm for minimizing states in a finite automaton. Theory of Machines
/// and Computations, 1971]: half-edges are states, the next one and the one across their letters.
struct Colours {
  Colours(const FaceGraph& a, const FaceGraph& b);

  int count = 0;                ///< colours are 0 to count - 1
  std::vector<int> of_a, of_b;  ///< colour of each half-edge
};

/// What one of the two meshes is in the search.
struct MapSide {
  const Polygons* polygons;
  int vertices;
  const Positions* positions;  ///< null where positions may not decide
};

/// Of two maps of one part the nearer one is taken where the other is this many times as far.
constexpr double kClearlyFarther = 2;

/// The similarity from `from` to `to` that the vertices with an image tell (-1: none); the identity
/// where they tell none.
Similarity told_by(const std::vector<VertexIndex>& image, const MapSide& from, const MapSide& to);

/// The image of each vertex: corner for corner, as the faces stand. None where that does not fit.
std::optional<std::vector<VertexIndex>> map_by_corners(const MapSide& from, const MapSide& to);

/// Face for face, from some corner each.
std::optional<std::vector<VertexIndex>> map_by_faces(const MapSide& from, const MapSide& to);

/// A map, or why there is none.
struct FoundMap {
  std::vector<VertexIndex> vertices = {};
  std::string why_not = {};  ///< empty where there is one
};

/// By how faces are joined and bounded, and of symmetric parts by positions where they may decide.
FoundMap map_by_graph(const MapSide& from, const MapSide& to);

}  // namespace mimetra
