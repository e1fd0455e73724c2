#pragma once

#include <vector>

#include "toolkit/correspondence/correspondence.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// A source deformed onto a target, and their triangles in pairs.
struct FoundCorrespondence {
  Correspondence correspondence;
  SurfaceFit fit;
  CorrespondenceQuality quality;
  /// The target's faces lead the other way round than the source's: they were paired as if turned.
  bool inside_out = false;
};

/// fit_to_surface(), pair_triangles() and with_unmarked_parts(). Throws what they and
/// is_inside_out() throw.
FoundCorrespondence find_correspondence(const TriMesh& source, const TriMesh& target,
                                        const std::vector<Marker>& markers,
                                        const SurfaceFitOptions& options = {},
                                        const Context& context = {});

}  // namespace mimetra
