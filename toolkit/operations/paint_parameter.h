#pragma once

#include <optional>

#include "toolkit/io/json_text.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/region_choice.h"

namespace mimetra {

/// --paint: how much of the motion each vertex of the source takes, from `field:NAME`, a picture,
/// or a list; see read_painting().
Parameter paint_parameter();

/// Exclusions by --paint: options and inputs that look for regions or name others, and weights of
/// each region.
std::vector<Exclusion> paint_exclusions();

/// The region that --paint makes of the source's vertices; none where it is not given. Warns of
/// what the painting's notes say. Throws MismatchError for a field that is not there or holds more
/// than a number for each vertex, and what read_painting() and check_painting() throw.
std::optional<GivenRegions> painted_region_of(const Invocation& invocation);

/// Where the weights of a target's vertices came from, and how many are 1, between and 0.
Json weights_report(const Eigen::VectorXd& weights, const Parameters& parameters,
                    const std::optional<Length>& falloff);

}  // namespace mimetra
