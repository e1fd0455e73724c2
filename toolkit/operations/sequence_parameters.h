#pragma once

#include "toolkit/io/sequence_format.h"
#include "toolkit/operations/bound_parameters.h"

namespace mimetra {

// The options of io as parameters of what reads and writes sequences.

/// --frames, and --fps of all that has no times.
BoundParameters<SequenceSource> frame_parameters();
/// --weight-scale.
BoundParameters<SequenceSource> weight_scale_parameter();
/// All that a sequence is read by: --weights, --topology, --frames and --fps.
BoundParameters<SequenceSource> sequence_parameters();
/// --double of mesh files, --single of arrays, and --format of folders, which have --double too.
BoundParameters<SequenceWriteOptions> mesh_writing_parameters();
BoundParameters<SequenceWriteOptions> array_writing_parameters();
BoundParameters<SequenceWriteOptions> folder_writing_parameters();

}  // namespace mimetra
