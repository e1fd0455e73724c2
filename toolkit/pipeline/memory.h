#pragma once

#include "toolkit/pipeline/solution.h"

namespace mimetra {

// Bytes that the steps take at their peak, besides what they were given. Counted are the arrays
// that grow with the sequence or the number of components.

/// All frames in memory.
double frame_bytes(const FrameSource& sequence);

/// What stored() has in memory; 0 for a source that is quick to read.
double stored_bytes(const FrameSource& sequence);

/// All frames without head motion; 0 where none is taken out.
double alignment_bytes(const FrameSource& sequence, const SourceOptions& options);

/// A decomposition into `count` components, alignment not included.
double analysis_bytes(const FrameSource& sequence, int count);

/// The choice of regions for a transfer to `target`.
double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target);

/// Set-up and result of a transfer to `target`.
double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options);

/// What weights of each of `regions` regions take besides.
double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const SolveOptions& options);

}  // namespace mimetra
