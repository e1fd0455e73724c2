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

/// Throws UsageError where the call is given components, and options of their decomposition, or
/// another number of them.
void check_given_components(const Invocation& invocation);

/// Throws UsageError where options of the call exclude each other or would have no effect: those of
/// a decomposition where regions are chosen for the transfer, and vertices to solve for.
void check_selection(const Invocation& invocation);

/// Lets regions fade out where no target has expressions and no option says how they end: a hard
/// border would tear the mesh.
void set_usual_border(const Invocation& invocation, SolveOptions& options);

/// Throws UsageError where one of the options is set, with the reason: "there are no regions".
void refuse_options(const Parameters& parameters, const std::vector<std::string>& names,
                    const std::string& reason);

}  // namespace mimetra
