#include "toolkit/operations/sequence_parameters.h"

namespace mimetra {

BoundParameters<SequenceSource> frame_parameters() {
  BoundParameters<SequenceSource> list;
  return list
      .add("frames", SequenceSource::kFrames, "part A:B:STEP of the frames, 0-based, B excluded")
      .brief("part A:B:STEP of the frames")
      .add("fps", SequenceSource::kFps, "frame rate of formats without times, as 30 or 24000/1001");
}

BoundParameters<SequenceSource> weight_scale_parameter() {
  BoundParameters<SequenceSource> list;
  return list.add(
      "weight-scale", SequenceSource::kWeightScale,
      "factor of the weights, as 0.01 for percent; without it, weights above 2 are refused");
}

BoundParameters<SequenceSource> sequence_parameters() {
  BoundParameters<SequenceSource> list;
  return list
      .add("weights", SequenceSource::kWeights,
           "CSV or JSON of blendshape weights that drive a model")
      .brief("CSV or JSON of weights that drive a model")
      .add(weight_scale_parameter())
      .add("topology", SequenceSource::kTopology, "mesh with the faces of a file that holds none")
      .add(frame_parameters());
}

BoundParameters<SequenceWriteOptions> mesh_writing_parameters() {
  BoundParameters<SequenceWriteOptions> list;
  return list.add("double", SequenceWriteOptions::kDoublePrecision,
                  "double precision in mesh files");
}

BoundParameters<SequenceWriteOptions> array_writing_parameters() {
  BoundParameters<SequenceWriteOptions> list;
  return list.add("single", SequenceWriteOptions::kSinglePrecision,
                  "single precision in .npy and .npz");
}

BoundParameters<SequenceWriteOptions> folder_writing_parameters() {
  BoundParameters<SequenceWriteOptions> list;
  return list.add("format", SequenceWriteOptions::kFormat, "format of frames in a folder")
      .add(mesh_writing_parameters());
}

}  // namespace mimetra
