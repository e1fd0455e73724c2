#pragma once

#include <optional>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// The connectivity of `mesh` with the triangles of `reference`, one by one, each wound as its
/// polygon of `mesh`; none unless both have the same polygons, in any order, each from some corner
/// and wound either way, and no polygon twice. The polygons of one may be cut in the other, as
/// quads are into triangles, along any diagonals.
std::optional<Connectivity> in_order_of(const Connectivity& reference, const Connectivity& mesh);

}  // namespace mimetra
