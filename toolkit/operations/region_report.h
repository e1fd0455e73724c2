#pragma once

#include <string>

#include "toolkit/operations/json.h"
#include "toolkit/regions/regions.h"

namespace mimetra {

/// What operations report about regions: keys regions, vertices, triangles, vertex_share, ...
Json report_of(const Regions& regions);
/// The same for people, one line.
std::string summary_of(const Regions& regions);

}  // namespace mimetra
