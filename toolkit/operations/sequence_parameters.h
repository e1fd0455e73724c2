#pragma once

#include "toolkit/io/sequence_format.h"
#include "toolkit/operations/bound_parameters.h"

namespace mimetra {

// The options of io as parameters for reading and writing sequences.

/// --frames, and --fps for sources without times.
BoundParameters<SequenceSource> frame_parameters();
/// --weight-scale.
BoundParameters<SequenceSource> weight_scale_parameter();
/// All parameters for reading a sequence: --weights, --weight-scale, --topology, --frames and
/// --fps.
BoundParameters<SequenceSource> sequence_parameters();
/// --double for mesh files, --single for arrays, and --format for folders, which also have
/// --double.
BoundParameters<SequenceWriteOptions> mesh_writing_parameters();
BoundParameters<SequenceWriteOptions> array_writing_parameters();
BoundParameters<SequenceWriteOptions> folder_writing_parameters();

}  // namespace mimetra
