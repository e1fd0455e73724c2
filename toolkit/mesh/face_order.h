#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// The connectivity of `mesh` with the triangles of `reference`, one by one, each wound as its
/// polygon of `mesh`; none unless both have the same polygons, in any order, each from some corner
/// and wound either way, and no polygon twice. The polygons of one may be cut in the other, as
/// quads are into triangles, along any diagonals.
std::optional<Connectivity> in_order_of(const Connectivity& reference, const Connectivity& mesh);

/// The polygon around some faces: their edges that no other of them has the other way round, from
/// the first such on; empty where these are not one cycle that meets no vertex twice.
std::vector<VertexIndex> outline(const Polygons& polygons, const std::vector<int>& faces);

}  // namespace mimetra
