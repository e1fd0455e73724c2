#pragma once

#include <vector>

#include "fitting/fit_options.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/image.h"
#include "toolkit/model/blendshape_model.h"

/// Checks of landmarks and options before a fit. Internal to fit_operation.h.
namespace mimetra {

/// Median distance between a perspective camera and the face over the frames, in units of the
/// longest side of the landmarks' box on the model. `focal_length` is in pixels. Infinity if no
/// frame has two landmarks.
double camera_distance(const MorphableModel& model, const MappedLandmarks& mapped,
                       double focal_length);

/// Throws UsageError if camera_distance() is less than 1, for example because the focal length is
/// in millimetres. Cameras are not that near: nose and chin would be beside them. `images` can be
/// null.
void check_focal_length(const FitOptions& options, const MorphableModel& model,
                        const MappedLandmarks& mapped, const ImageSequence* images);

/// Uncertainty of the head's rotation when only some landmarks are seen, in degrees (RMS). It
/// assumes a face seen from the front, the noise of one picture (kUsualSigma) and expressions
/// anywhere in [0, 1].
class TurnUncertainty {
 public:
  /// `ahead` rotates the model so that it looks along +z with y up.
  TurnUncertainty(const MorphableModel& model, const std::vector<int>& vertices,
                  const Eigen::Matrix3d& ahead);

  /// Uncertainty if the landmarks `seen` are seen; these are indices into `vertices`.
  double of(const std::vector<Eigen::Index>& seen) const;

 private:
  Eigen::MatrixXd image_;  ///< derivatives of x, y, x, ... of the landmarks by the unknowns
  Eigen::VectorXd prior_;  ///< inverse variance of the unknowns
};

/// Frames whose landmarks leave the head's rotation uncertain by more than 4 degrees, as nose or
/// mouth alone do. If most frames are uncertain, only frames with fewer landmarks than a camera
/// needs (four) are returned. The result is empty if all frames are uncertain.
std::vector<int> partial_frames(const MorphableModel& model, const MappedLandmarks& mapped);

}  // namespace mimetra
