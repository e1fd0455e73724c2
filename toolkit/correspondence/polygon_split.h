#pragma once

#include <optional>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// `fine` with successive faces joined across the edges they share, so that there are as many
/// corners in each face as in that face of `coarse`; none where they cannot be.
std::optional<Polygons> joined_like(const Polygons& coarse, const Polygons& fine);

}  // namespace mimetra
