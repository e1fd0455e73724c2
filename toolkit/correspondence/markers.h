#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A vertex of the source and the one of the target that is the same point of a face; 0-based.
struct Marker {
  VertexIndex source;
  VertexIndex target;

  bool operator==(const Marker&) const = default;
};

/// Fewer do not hold a surface in space.
constexpr int kFewestMarkers = 4;

/// Throws MismatchError for a vertex that is not there, one that is in two markers, fewer than four
/// markers, and markers that lie in one plane in a mesh (positions N x 3).
void check_markers(const std::vector<Marker>& markers, const Positions& source,
                   const Positions& target);

/// What an affine map of the markers from source to target leaves: root mean square distance, as a
/// share of the target markers' own root mean square distance from their centre.
double affine_residual(const std::vector<Marker>& markers, const Positions& source,
                       const Positions& target);

}  // namespace mimetra
