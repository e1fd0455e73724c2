#pragma once

#include <vector>

#include "geodesic/types.h"

namespace mimetra::bench {

/// Distances from each source (N) as CGAL's own heat method finds them: one object on the intrinsic
/// Delaunay triangulation, set up here, and one query after the other.
std::vector<Eigen::VectorXd> cgal_distances(const geodesic::Positions& positions,
                                            const geodesic::Triangles& triangles,
                                            const std::vector<int>& sources);

}  // namespace mimetra::bench
