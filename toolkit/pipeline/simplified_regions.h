#pragma once

#include "toolkit/mesh/simplification.h"
#include "toolkit/pipeline/region_choice.h"

namespace mimetra {

/// Regions that were found on fewer vertices.
struct SimplifiedRegions {
  Simplification mesh;
  Regions regions;  ///< on the given mesh (carried_regions())
  double seconds = 0;
};

/// Decomposes a source on a share of its vertices, chooses regions there, and measures their discs
/// along the whole mesh: much less work where the mesh is fine. Throws std::invalid_argument for
/// RegionShape::support, which is no disc; what simplify(), analyse() and choose_regions() throw.
SimplifiedRegions regions_by_simplified(const Source& source, const SimplifyOptions& simplifying,
                                        const AnalysisOptions& analysis = {},
                                        const RegionChoiceOptions& choice = {},
                                        const Context& context = {});

}  // namespace mimetra
