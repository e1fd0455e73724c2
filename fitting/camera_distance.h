#pragma once

#include "fitting/fit_options.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/model/morphable_model.h"
#include "toolkit/operations/image_sequence.h"

/// How near a focal length puts a face. Internal to fit_operation.h.
namespace mimetra {

/// Of a perspective camera from the face, in the median frame, as a multiple of the longest side of
/// the landmarks' box on the model; `focal_length` in pixels. Infinity where no frame has two
/// landmarks.
double camera_distance(const MorphableModel& model, const MappedLandmarks& mapped,
                       double focal_length);

/// Throws UsageError where that is less than 1, as where the focal length is in millimetres:
/// cameras are not so near, and nose and chin would be beside them. `images` of the landmarks, or
/// null.
void check_focal_length(const FitOptions& options, const MorphableModel& model,
                        const MappedLandmarks& mapped, const ImageSequence* images);

}  // namespace mimetra
