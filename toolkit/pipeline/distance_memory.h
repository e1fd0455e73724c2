#pragma once

#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

/// Bytes that exact distances from several sources take on `threads` threads (0 for all there are),
/// each of which asks from one at a time.
double exact_distance_bytes(Eigen::Index vertices, int threads, int sources);

/// Bytes that distances by this method take besides what planned_decomposition() counts of them,
/// taken out of the memory that the decomposition may take. Throws MismatchError where they leave
/// none.
double reserved_for_distances(DecompositionOptions& decomposition, GeodesicMethod method,
                              Eigen::Index vertices, int threads);

}  // namespace mimetra
