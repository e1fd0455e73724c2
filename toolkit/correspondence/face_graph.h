#pragma once

#include <cstdint>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// What lies beyond an edge.
enum class EdgeKind : std::uint8_t {
  inner,    ///< one other face, oriented alike
  border,   ///< nothing
  tangled,  ///< more than one other face, or one oriented the other way
};

/// Polygons and how they are joined. The half-edge c of a mesh leads from corner c of its polygons
/// to the next corner of that polygon.
struct FaceGraph {
  explicit FaceGraph(const Polygons& polygons);

  int size() const { return static_cast<int>(next.size()); }

  std::vector<VertexIndex> vertex;  ///< where each half-edge begins
  std::vector<int> face, next;
  std::vector<int> opposite;  ///< -1 but for inner edges
  std::vector<EdgeKind> kind;
};

/// What tells the half-edges of two meshes apart by how faces are joined around them, however far
/// away: those with one colour may be each other's image, others cannot. Takes n log n steps.
///
/// [Hopcroft. An n log n algorithm for minimizing states in a finite automaton. Theory of Machines
/// and Computations, 1971]: half-edges are states, the next one and the one across their letters.
struct Colours {
  Colours(const FaceGraph& a, const FaceGraph& b);

  int count = 0;                ///< colours are 0 to count - 1
  std::vector<int> of_a, of_b;  ///< of each half-edge
};

}  // namespace mimetra
