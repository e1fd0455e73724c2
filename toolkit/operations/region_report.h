#pragma once

#include <string>

#include "toolkit/operations/json.h"
#include "toolkit/regions/regions.h"

namespace mimetra {

/// What operations report about regions: keys regions, vertices, triangles, vertex_share, ...;
/// energy_share is null where it is not known.
Json report_of(const Regions& regions);
/// The same for people, one line.
std::string summary_of(const Regions& regions);
/// Those of the regions that were added for a target's expressions.
Json added_regions(const Regions& regions);

}  // namespace mimetra
