#pragma once

#include "toolkit/pipeline/analysis.h"
#include "toolkit/pipeline/solution.h"
#include "toolkit/splocs/decomposition_plan.h"

namespace mimetra {

// Bytes that the steps take at their peak, besides what they were given. Counted are the arrays
// that grow with the sequence or the number of components.

/// All frames in memory.
double frame_bytes(const FrameSource& sequence);

/// What simplify() takes of a sequence.
double simplify_bytes(const FrameSource& sequence);

/// What stored() has in memory; 0 for a source that is quick to read.
double stored_bytes(const FrameSource& sequence);

/// How analyse() keeps within the memory of its context, on this process. Throws as
/// planned_decomposition().
DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context);

/// The choice of regions for a transfer to `target`.
double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target);

/// Set-up and result of a transfer to `target`.
double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context);

/// What weights of each of `regions` regions take besides.
double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context);

}  // namespace mimetra
