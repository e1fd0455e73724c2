#pragma once

#include <vector>

#include "toolkit/regions/disc_search.h"

namespace mimetra {

struct FarthestDiscsOptions {
  double radius = 1;  ///< along the surface, length > 0
  int count = 400;    ///< >= 1
  /// Vertices that discs may hold (N); empty for all.
  std::vector<bool> inside = {};
};

/// Discs of one radius that are spread over a mesh: around the vertex that is farthest from the
/// mean of all, then each time around the one that is farthest, straight through space, from all
/// centres so far; fewer than asked for where every vertex is a centre. Vertices without triangle
/// are none. `positions` N x 3, `triangles` M x 3, `distances` along them. Throws
/// std::invalid_argument for options out of range, and what the distances throw.
std::vector<Disc> farthest_discs(const Positions& positions, const Triangles& triangles,
                                 const DistanceFunction& distances,
                                 const FarthestDiscsOptions& options);

}  // namespace mimetra
