#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// The polygon around some faces: their edges that no other of them has the other way round, from
/// the first such on; empty where these are not one cycle that meets no vertex twice.
std::vector<VertexIndex> outline(const Polygons& polygons, const std::vector<int>& faces);

}  // namespace mimetra
