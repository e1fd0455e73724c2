#pragma once

#include <optional>

#include "toolkit/io/json_text.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/region_choice.h"

namespace mimetra {

/// --paint: each vertex's share of the source's motion, from `field:NAME`, a picture, or a list;
/// see read_painting().
Parameter paint_parameter();

/// Exclusions by --paint: options and inputs that look for regions or give others, and weights of
/// each region.
std::vector<Exclusion> paint_exclusions();

/// Returns the region that --paint makes of the source's vertices; empty without --paint. Warns
/// with the painting's notes. Throws MismatchError for a field that does not exist or has several
/// numbers per vertex, and what read_painting() and check_painting() throw.
std::optional<GivenRegions> painted_region_of(const Invocation& invocation);

/// Reports the source of a target's vertex weights, and how many are 1, between 0 and 1, and 0.
Json weights_report(const Eigen::VectorXd& weights, const Parameters& parameters,
                    const std::optional<Length>& falloff);

}  // namespace mimetra
