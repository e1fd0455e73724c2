#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Connectivity of `mesh` with the triangles of `reference`, in their order, each wound as its
/// polygon of `mesh`.
///
/// Returns none unless both have the same polygons, none of them twice. Order, first corner and
/// winding may differ. The polygons of one mesh may be cut in the other along any diagonals, as
/// quads are cut into triangles.
std::optional<Connectivity> in_order_of(const Connectivity& reference, const Connectivity& mesh);

/// Polygon around the given faces. It consists of the edges that no other of these faces has in the
/// opposite direction, and starts with the first such edge. Empty unless these edges form one cycle
/// that meets no vertex twice.
std::vector<VertexIndex> outline(const Polygons& polygons, const std::vector<int>& faces);

}  // namespace mimetra
