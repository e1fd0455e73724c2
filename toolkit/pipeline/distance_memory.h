#pragma once

#include "toolkit/mesh/context.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// Bytes that distances from several sources take besides what planned_decomposition() counts, if
/// each thread asks from one source at a time. Only exact distances take any.
double distance_bytes(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

/// The context with the memory that these distances leave. Throws MismatchError if they take more
/// than there is.
Context beside_distances(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

}  // namespace mimetra
