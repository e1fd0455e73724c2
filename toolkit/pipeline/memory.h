#pragma once

#include "toolkit/pipeline/analysis.h"
#include "toolkit/pipeline/solution.h"
#include "toolkit/splocs/decomposition_plan.h"

namespace mimetra {

// Peak memory of the steps in bytes, without their inputs. The functions count the arrays that grow
// with the sequence or the number of components.

/// All frames in memory.
double frame_bytes(const FrameSource& sequence);

/// Bytes that simplify() takes.
double simplify_bytes(const FrameSource& sequence);

/// Bytes of a stored() sequence that stay in memory; 0 for a source that is quick to read.
double stored_bytes(const FrameSource& sequence);

/// How analyse() keeps within the memory of its context, on this process. Throws as
/// planned_decomposition().
DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context);

/// Bytes that the choice of regions for a transfer to `target` takes.
double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target);

/// Bytes of the set-up and the result of a transfer to `target`.
double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context);

/// Further bytes if each of `regions` regions has its own weights.
double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context);

}  // namespace mimetra
