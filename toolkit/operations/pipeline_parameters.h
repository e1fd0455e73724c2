#pragma once

#include <string>

#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/evaluation.h"
#include "toolkit/pipeline/transfer.h"
#include "toolkit/splocs/decomposition_plan.h"

namespace mimetra {

// The pipeline's options as parameters, shared by operations. Files that a call names must fit
// `sequence`; without one they are not read, and what they hold is empty.

// Headings of the help under which they stand.
inline constexpr const char* kRegionGroup = "Regions";
inline constexpr const char* kDecompositionGroup = "Decomposition";
inline constexpr const char* kSourceGroup = "Rest pose and head motion";
inline constexpr const char* kSolvingGroup = "Solving";

/// --align.
BoundParameters<SourceOptions> alignment_parameters(const FrameSource* sequence = nullptr);
/// --source-rest of a transfer, and --rest of its decomposition.
BoundParameters<SourceOptions> source_rest_parameters(const FrameSource* sequence = nullptr);
BoundParameters<AnalysisOptions> analysis_rest_parameters(const FrameSource* sequence = nullptr);
/// --rest of a sequence that is decomposed.
BoundParameters<SourceOptions> rest_parameters(const FrameSource* sequence = nullptr);
/// --geodesics and --weld.
BoundParameters<DistanceOptions> distance_parameters();
/// -k, by default as many as the decomposition of `defaults` has.
BoundParameters<AnalysisOptions> count_parameters(const AnalysisOptions& defaults = {});
/// All others of a decomposition but for its rest pose, the distances' included, with --only and
/// --without, which name vertices of `sequence`.
BoundParameters<AnalysisOptions> analysis_parameters(const FieldSequence* sequence = nullptr);
/// --select, --triangles, --radius, --region and --coverage.
BoundParameters<RegionChoiceOptions> region_parameters();
BoundParameters<RegionChoiceOptions> completion_parameters();
/// --space and what belongs to each.
BoundParameters<SolveOptions> solving_parameters();
/// Those of weights alone: --axes, and of the weights themselves.
BoundParameters<SolveOptions> axes_parameters();
BoundParameters<BlendshapeTransferOptions> blendshape_parameters();

/// Throws UsageError for options of a solve that would do nothing beside others: those of triangles
/// outside where there are none, --region-ridge without --per-region, and with it those that such
/// weights do not follow, also for targets that are solved for vertices.
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

/// What was done about head motion, for reports.
Json json_of(const HeadMotionTaken& motion);

/// True for the vertex space of --space, and where a target has no expressions to solve for.
bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target);

/// How the decomposition of a sequence, of which `count` components are asked for, keeps within
/// --memory; what is kept of frames that are slow to read is included. Nothing for components that
/// are given.
DecompositionPlan analysis_plan(const Invocation& invocation, const FrameSource& source, int count);

}  // namespace mimetra
