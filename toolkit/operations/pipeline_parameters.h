#pragma once

#include <string>

#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/transfer.h"
#include "toolkit/splocs/decomposition_plan.h"

namespace mimetra {

// The pipeline's options as parameters, shared by operations.

// Headings of the help under which they stand.
inline constexpr const char* kRegionGroup = "Regions";
inline constexpr const char* kSolvingGroup = "Solving";

/// --align.
BoundParameters<SourceOptions> alignment_parameters();
/// --source-rest of a transfer, and --rest of its decomposition.
BoundParameters<SourceOptions> source_rest_parameters();
BoundParameters<AnalysisOptions> analysis_rest_parameters();
/// --rest of a sequence that is decomposed.
BoundParameters<SourceOptions> rest_parameters();
/// --geodesics and --weld.
BoundParameters<DistanceOptions> distance_parameters();
/// -k, by default as many as `defaults` has.
BoundParameters<AnalysisOptions> count_parameters(const AnalysisOptions& defaults = {});
/// All others of a decomposition but for its rest pose, with those of distances, and with --only
/// and --without, which name vertices of the sequence.
BoundParameters<AnalysisOptions> analysis_parameters();
/// --select, --triangles, --radius, --region and --coverage.
BoundParameters<RegionChoiceOptions> region_parameters();
BoundParameters<RegionChoiceOptions> completion_parameters();
/// --space and what belongs to each.
BoundParameters<SolveOptions> solving_parameters();

/// --axes.
template <typename Options>
BoundParameters<Options> axes_parameters() {
  BoundParameters<Options> list;
  return list
      .add("axes", Options::kAxes,
           "fit: the source is turned as its rest pose is to the target's; none: it is not")
      .under(kSolvingGroup);
}

/// --triangle-weight.
template <typename Options>
BoundParameters<Options> triangle_weight_parameters() {
  BoundParameters<Options> list;
  return list
      .add("triangle-weight", Options::kTriangleWeight,
           "vertex space: every triangle alike, or by area")
      .under(kSolvingGroup);
}

/// --ridge, --l1, --symmetry and --exclusive.
template <typename Options>
BoundParameters<Options> blendshape_parameters() {
  BoundParameters<Options> list;
  return list.add("ridge", Options::kRidge, "pull of the weights towards 0")
      .add("l1", Options::kSparsity, "sparsity of the weights")
      .add("symmetry", Options::kSymmetry,
           "how much the weights of the left and the right half of an expression are drawn "
           "together; pairs are known by their names, or by --rules")
      .add("exclusive", Options::kExclusive,
           "expressions of which at most one is there in a frame, by ARKit's names; eyes: looking "
           "up or down, and in or out; all: jawOpen or mouthClose, too");
}

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

/// The call's context, within the memory of --memory: by default what the machine has left.
Context within_memory(const Invocation& invocation);

/// Exclusions among the options of a solve, and of --rest by --select transfer.
std::vector<Exclusion> solving_exclusions();

/// Throws UsageError for options of a solve that would do nothing for the call's targets:
/// --outside-weight without triangles outside, --per-region if one is solved for vertices.
void check_solving(const Invocation& invocation);

/// Throws what check_border() throws for the targets of a call, as the command says it.
void check_border(const Invocation& invocation, const GivenRegions* given,
                  const SolveOptions& options);

/// The options, with what an input that is a sequence says of itself.
SourceOptions described(SourceOptions options, const NamedData& input);

/// The optional input `components` of a call.
std::optional<GivenComponents> given_components(const Invocation& invocation);

/// The output `components-out` of operations that decompose on the way to something else.
Output components_output();

/// True for the vertex space of --space, and where a target has no expressions to solve for.
bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target);

/// How the decomposition of a sequence keeps within --memory. The plan includes what is kept of
/// frames that are slow to read. It is empty for components that are given.
DecompositionPlan analysis_plan(const Invocation& invocation, const FrameSource& source,
                                const AnalysisOptions& options);

}  // namespace mimetra
