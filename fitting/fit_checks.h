#pragma once

#include <vector>

#include "fitting/fit_options.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/operations/image.h"

/// Checks of landmarks and options before a fit. Internal to fit_operation.h.
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

/// By how many degrees (RMS) a head may be turned otherwise than what fits some of its landmarks
/// says: seen from the front, with the noise of one picture (kUsualSigma) and expressions
/// anywhere in [0, 1].
class TurnUncertainty {
 public:
  /// `ahead` carries the model to one that looks along +z with y up.
  TurnUncertainty(const MorphableModel& model, const std::vector<int>& vertices,
                  const Eigen::Matrix3d& ahead);

  /// Of landmarks that are seen, by their places in `vertices`.
  double of(const std::vector<Eigen::Index>& seen) const;

 private:
  Eigen::MatrixXd image_;  ///< derivatives of the landmarks' x, y, x, ... by what is unknown
  Eigen::VectorXd prior_;  ///< inverse variance of what is unknown
};

/// Frames with landmarks that leave the head's turn open by more than 4 degrees, as those of nose
/// or mouth alone do. Where most frames are such they are what there is to go by, and only those
/// with too few for a camera, four, are meant; none where all are such.
std::vector<int> partial_frames(const MorphableModel& model, const MappedLandmarks& mapped);

}  // namespace mimetra
