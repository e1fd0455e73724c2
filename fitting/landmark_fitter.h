#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/fit_options.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/morphable_model.h"

namespace mimetra {

/// What was fitted to one frame.
struct FrameFit {
  AffineCamera camera = AffineCamera::Zero();
  Eigen::VectorXd alpha;  ///< one per identity
  Eigen::VectorXd beta;   ///< one per expression, within the bounds
  /// Root of the mean squared distance between landmarks and their projections, in pixels; NaN
  /// where none was seen.
  double rms = 0;
  /// Noise that was assumed, in pixels.
  double sigma = 0;
  /// Landmarks seen. Where it is 0, camera and coefficients are interpolated in time between the
  /// nearest frames with some, or those of the one there is.
  int landmarks = 0;
  int iterations = 0;
  /// After each iteration: sum over frames of |residual|^2 / (2 sigma^2) + ridge |beta|^2, plus
  /// |alpha|^2 (eq. 4) and the smoothness term; over the clip where frames are solved together, of
  /// this frame otherwise. It never rises.
  std::vector<double> energies;
};

/// Fits a morphable model to the 2D landmarks of a clip: minimises over affine cameras, alpha and
/// 0 <= beta <= 1 the reprojection error with a prior on alpha (eq. 4, 5).
///
/// The constructor takes the landmarks' rows from the model and folds their products, so that no
/// camera costs a normal matrix over landmarks. Queries are const.
///
/// [Do, Ma, Cao, An. Region-based deformation transfer], section III-A
class LandmarkFitter {
 public:
  /// `vertices`: the model's vertex of each landmark (n). Throws MismatchError for a vertex that
  /// the model does not have.
  LandmarkFitter(const MorphableModel& model, std::vector<int> vertices);
  ~LandmarkFitter();
  LandmarkFitter(LandmarkFitter&&) noexcept;
  LandmarkFitter& operator=(LandmarkFitter&&) noexcept;

  /// `points` F x 2n: x0 y0 x1 y1 ... in pixels, y down, 0-based; NaN for landmarks not seen.
  /// `times` in seconds (F), ascending; frames are evenly spaced without. Throws
  /// std::invalid_argument where sizes disagree or an option is out of range; MismatchError where
  /// no frame has landmarks, or those of a frame are fewer than four or coplanar; Cancelled.
  std::vector<FrameFit> fit(const Frames& points, const FitOptions& = {},
                            const Eigen::VectorXd& times = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
