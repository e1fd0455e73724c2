#pragma once

#include "toolkit/io/sequence_options.h"
#include "toolkit/operations/bound_parameters.h"

namespace mimetra {

// The options of io as parameters of what reads and writes sequences.

/// --frames and --fps, of all that has frames.
BoundParameters<SequenceSource> frame_parameters();
/// All that a sequence is read by: --weights, --topology, --frames and --fps.
BoundParameters<SequenceSource> sequence_parameters();
/// --format, --double and --single.
BoundParameters<SequenceWriteOptions> sequence_writing_parameters();

}  // namespace mimetra
