#pragma once

#include "toolkit/mesh/simplification.h"
#include "toolkit/regions/regions.h"

namespace mimetra {

/// Discs that were found on a simplified mesh, on the one that it was made from: of the same radius
/// around the same vertices, by `distances` along that one, whose triangles these are (M x 3).
/// `vertex_energy` (N): each vertex' share of the motion energy on it, of which regions hold
/// theirs. Of vertices not `inside` (N, empty for all) none is in a region. Throws
/// std::invalid_argument for regions of another number of vertices than were kept, and for one that
/// has no centre; what the distances throw.
Regions carried_regions(const Regions& regions, const Simplification& simplified,
                        Eigen::VectorXd vertex_energy, const Triangles& triangles,
                        const DistanceFunction& distances, const std::vector<bool>& inside = {});

}  // namespace mimetra
