#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/tri_mesh.h"

/// Maps of the vertices of one mesh onto those of another that has the same faces. Internal to
/// renumbering().
namespace mimetra {

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
