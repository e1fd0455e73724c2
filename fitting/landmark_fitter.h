#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/fit_options.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// What was fitted to one frame.
struct FrameFit {
  AffineCamera camera = AffineCamera::Zero();
  /// Third row of the camera's matrix; other than (0, 0, 0, 1) for a perspective one.
  Eigen::RowVector4d depth = {0, 0, 0, 1};
  Eigen::VectorXd alpha;  ///< one per identity
  Eigen::VectorXd beta;   ///< one per expression, within the bounds
  /// Root of the mean squared distance between landmarks and their projections, in pixels; NaN
  /// where none was seen.
  double rms = 0;
  /// The same with the distances of landmarks to the outline on which they lie.
  double rms_all = 0;
  /// Noise that was assumed or estimated, in pixels; share of its square that is the same in every
  /// frame.
  double sigma = 0;
  double repeated = 0;
  /// Landmarks seen. Where it is 0, camera and coefficients are interpolated in time between the
  /// nearest frames with some, or those of the one there is.
  int landmarks = 0;
  int iterations = 0;
  /// After each iteration with the last noise: sum over frames of |residual|^2 / (2 sigma^2) +
  /// ridge |beta|^2, plus |alpha|^2 (eq. 4) and the smoothness term; over the clip where frames are
  /// solved together, of this frame otherwise. Where noise is estimated, landmarks are weighed, the
  /// camera's stretch counts, and |alpha|^2 weighs F / 2 over the number of independent frames. It
  /// never rises.
  std::vector<double> energies;
};

/// Fits a morphable model to the 2D landmarks of a clip: minimises over cameras, alpha and
/// 0 <= beta <= 1 the reprojection error with a prior on alpha (eq. 4, 5).
///
/// The constructor takes the landmarks' rows from the model and folds their products, so that no
/// camera costs a normal matrix over landmarks. Queries are const.
///
/// [Do, Ma, Cao, An. Region-based deformation transfer], section III-A
class LandmarkFitter {
 public:
  /// Whether landmarks on the outline will be given: the fitter keeps a copy of the model then.
  enum class Outline { none, given };

  /// `vertices`: the model's vertex of each landmark (n). Throws MismatchError for a vertex that
  /// the model does not have.
  LandmarkFitter(const MorphableModel& model, const std::vector<int>& vertices,
                 Outline outline = Outline::none);
  ~LandmarkFitter();
  LandmarkFitter(LandmarkFitter&&) noexcept;
  LandmarkFitter& operator=(LandmarkFitter&&) noexcept;

  /// `points` F x 2n: x0 y0 x1 y1 ... in pixels, y down, 0-based; NaN for landmarks not seen.
  /// `times` in seconds (F), ascending; frames are evenly spaced without. `outline` F x 2m, alike:
  /// landmarks somewhere on the outline of the face as each camera sees it, which are used where
  /// the noise is estimated. Throws
  /// std::invalid_argument where sizes disagree or an option is out of range; MismatchError where
  /// no frame has landmarks, or those of a frame are fewer than four or coplanar; Cancelled.
  std::vector<FrameFit> fit(const Frames& points, const FitOptions& = {},
                            const Eigen::VectorXd& times = {}, const Frames& outline = {},
                            const Context& = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
