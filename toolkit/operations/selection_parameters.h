#pragma once

#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/solution.h"

namespace mimetra {

/// --select, --triangles and --drop-rims.
BoundParameters<RegionChoiceOptions> selection_parameters();

/// The options with what -k says where regions are chosen for the transfer: discs at most, and any
/// number of them where nobody says so.
RegionChoiceOptions with_most_discs(RegionChoiceOptions options, const Parameters& parameters);

/// Options that only regions by energy depend on.
const std::vector<std::string>& options_of_energy();

/// Those of them, but for -k, that the decomposition depends on.
const std::vector<std::string>& options_of_decomposition();

/// Exclusions of a decomposition's options by --components and by --select transfer, and of
/// --select transfer by --space vertex.
std::vector<Exclusion> selection_exclusions();

/// Throws UsageError if the call is given components, and -k asks for another number of them.
void check_given_components(const Invocation& invocation);

/// Lets regions fade out where no target has expressions and no option says how they end: a hard
/// border would tear the mesh.
void set_usual_border(const Invocation& invocation, SolveOptions& options);

}  // namespace mimetra
