#pragma once

#include <string>

#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/transfer.h"
#include "toolkit/splocs/decomposition_plan.h"

namespace mimetra {

// The pipeline's options as parameters, shared by operations.

// Headings of these parameters in the help.
inline constexpr const char* kRegionGroup = "Regions";
inline constexpr const char* kSolvingGroup = "Solving";

/// --align.
BoundParameters<SourceOptions> alignment_parameters();
/// --source-rest of a transfer, and --rest of its decomposition.
BoundParameters<SourceOptions> source_rest_parameters();
BoundParameters<AnalysisOptions> analysis_rest_parameters();
/// --rest of a sequence to be decomposed.
BoundParameters<SourceOptions> rest_parameters();
/// --geodesics and --weld.
BoundParameters<DistanceOptions> distance_parameters();
/// -k; its default comes from `defaults`.
BoundParameters<AnalysisOptions> count_parameters(const AnalysisOptions& defaults = {});
/// All other parameters of a decomposition except the rest pose. Includes distances, and --only and
/// --without, which select vertices of the sequence.
BoundParameters<AnalysisOptions> analysis_parameters();
/// --select, --triangles, --radius, --region and --coverage.
BoundParameters<RegionChoiceOptions> region_parameters();
BoundParameters<RegionChoiceOptions> completion_parameters();
/// --space and the parameters of each space.
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

/// Returns the options with -k as the largest number of discs, if regions are chosen for the
/// transfer. Without -k the number has no limit.
RegionChoiceOptions with_most_discs(RegionChoiceOptions options, const Parameters& parameters);

/// Options that affect only regions by energy.
const std::vector<std::string>& options_of_energy();

/// Options of these, except -k, that affect the decomposition.
const std::vector<std::string>& options_of_decomposition();

/// Exclusions of a decomposition's options by --components and by --select transfer, and of
/// --select transfer by --space vertex.
std::vector<Exclusion> selection_exclusions();

/// Throws UsageError if the call has components, and -k requests another number of them.
void check_given_components(const Invocation& invocation);

/// Sets the falloff kBareFalloff if no target has expressions and no option decides the border. A
/// hard border would tear the mesh.
void set_usual_border(const Invocation& invocation, SolveOptions& options);

/// Returns the call's context with the limit --memory, by default the memory that the machine has
/// left.
Context within_memory(const Invocation& invocation);

/// Exclusions among the options of a solve, and of --rest by --select transfer.
std::vector<Exclusion> solving_exclusions();

/// Throws UsageError for options of a solve without effect on the call's targets: --outside-weight
/// without triangles outside, --per-region if a target is solved for vertices.
void check_solving(const Invocation& invocation);

/// Throws what check_border() throws for the targets of a call, with the command's option names.
void check_border(const Invocation& invocation, const GivenRegions* given,
                  const SolveOptions& options);

/// Adds a sequence input's name to the options, and whether a model drives it.
SourceOptions described(SourceOptions options, const NamedData& input);

/// Returns the optional input `components` of a call.
std::optional<GivenComponents> given_components(const Invocation& invocation);

/// Declares the output `components-out` of operations that decompose as a step.
Output components_output();

/// True for --space vertex, and if a target has no expressions.
bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target);

/// Plan that keeps a sequence's decomposition within --memory. Includes the stored frames of
/// sources that are slow to read. Empty if components are given.
DecompositionPlan analysis_plan(const Invocation& invocation, const FrameSource& source,
                                const AnalysisOptions& options);

}  // namespace mimetra
