#pragma once

#include <string>
#include <vector>

#include "fitting/affine_camera.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Affine cameras that see the model's origin, and a little around it, as the fitted ones do.
std::vector<AffineCamera> cameras_at_origin(const FittedCoefficients& fit);

/// How many of a clip's landmarks its cameras do not see, for the face is between. Internal to
/// fit_operation.h.
class AvertedLandmarks {
 public:
  /// One camera a frame of the fitted `sequence`; landmarks at `vertices`. Frames without landmarks
  /// in `fit` do not count.
  AvertedLandmarks(const MeshSequence& sequence, const FittedCoefficients& fit,
                   const std::vector<int>& vertices, const std::vector<AffineCamera>& cameras);

  /// Throws MismatchError where most frames' faces look away from the camera: a mirror image fits
  /// as well, as such a face, which nobody finds landmarks of. `name` of the landmarks.
  void require_facing(const std::string& name) const;

  /// The landmarks' notes of frames, with those in which the head is turned so far that landmarks
  /// are behind it, of which it warns; none where no frame has one.
  std::vector<std::string> notes(const Invocation& invocation) const;

 private:
  std::vector<int> of_frames_;  ///< -1 of unseen ones
  int landmarks_;
};

}  // namespace mimetra
