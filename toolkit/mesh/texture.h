#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Whether any corner of a face has texture coordinates.
bool has_texture(const Connectivity& connectivity);

/// The texture coordinates of each vertex (N), where all corners at a vertex have equal ones;
/// vertices at no such corner have 0. None where a vertex has several, as at the seams of a
/// texture, or the mesh has no texture coordinates.
std::optional<std::vector<Eigen::Vector2d>> texture_of_vertices(const Connectivity& connectivity);

}  // namespace mimetra
