#pragma once

#include <vector>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// A boundary spans a connected part if the farthest of its vertices are apart by this share of the
/// part's diameter. Necks and the edges of face masks span half of it and more, mouths and eyes
/// that a face leaves open a third at most.
constexpr double kRimShare = 0.4;

/// Vertices on the rims of a surface, where a scan ends or a face is cut out of a head, and those
/// that share a triangle with them (N). Of each connected part that is the longest boundary, if it
/// spans the part; shorter ones are openings in the surface. Edges of one triangle are a boundary,
/// where coinciding vertices are welded; the parts of a boundary hang together by vertices. Throws
/// std::invalid_argument where sizes differ, or for a triangle with a vertex that is not there.
std::vector<bool> near_rims(const Positions& positions, const Triangles& triangles,
                            const Weld& weld);

}  // namespace mimetra
