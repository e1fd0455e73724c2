#pragma once

#include "toolkit/correspondence/correspondence.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// `pairs` with those of parts that no marker reaches, of both meshes: teeth and eyes of heads that
/// are made alike. The source's such parts are carried by the similarity of the fitted surface
/// around them (200 vertices), and pair_triangles() pairs what lies over each other then. A part of
/// the target is taken if three quarters of its triangles have a partner, a tenth of its own size
/// away on average at most; another is left without.
Correspondence with_unmarked_parts(Correspondence pairs, const SurfaceFit& fit,
                                   const TriMesh& source, const TriMesh& target,
                                   const Context& context = {});

}  // namespace mimetra
