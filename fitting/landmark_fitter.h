#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/fit_options.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Fit of one frame.
struct FrameFit {
  AffineCamera camera = AffineCamera::Zero();
  /// Third row of the camera's matrix, (0, 0, 0, 1) unless the camera is a perspective one.
  Eigen::RowVector4d depth = {0, 0, 0, 1};
  Eigen::VectorXd alpha;  ///< one coefficient per identity
  Eigen::VectorXd beta;   ///< one coefficient per expression, within the bounds
  /// Root of the mean squared distance between landmarks and their projections, in pixels. NaN if
  /// no landmark is seen.
  double rms = 0;
  /// As `rms`, including the distances of the outline's landmarks from the outline.
  double rms_all = 0;
  /// Assumed or estimated noise in pixels, and the share of its square that is the same in every
  /// frame.
  double sigma = 0;
  double repeated = 0;
  /// Number of landmarks seen. If it is 0, camera and coefficients are interpolated in time between
  /// the nearest frames with landmarks. They are copied if such frames are on one side only.
  int landmarks = 0;
  int iterations = 0;
  /// Energy after each iteration for the final noise; it never rises. Summed over the frames that
  /// were solved together: |residual|^2 / (2 sigma^2) + ridge |beta|^2, plus |alpha|^2 (eq. 4) and
  /// the smoothness term. Landmark weights and the camera's stretch are included if they are used.
  /// The weight of |alpha|^2 is F over the number of independent frames, and half of it if sigma is
  /// estimated.
  std::vector<double> energies;
};

/// Fits a morphable model to the 2D landmarks of a clip. Minimises the reprojection error over
/// cameras, alpha and 0 <= beta <= 1, with a prior on alpha (eq. 4, 5). The constructor takes the
/// landmarks' rows from the model and folds their products, so no camera costs a normal matrix over
/// landmarks. Queries are const.
///
/// [Do, Ma, Cao, An. Region-based deformation transfer], section III-A
class LandmarkFitter {
 public:
  /// Whether fit() gets landmarks on the outline; if so, the fitter keeps a copy of the model.
  enum class Outline { none, given };

  /// `vertices` holds the model's vertex of each landmark (n). Throws MismatchError for a vertex
  /// that the model does not have.
  LandmarkFitter(const MorphableModel& model, const std::vector<int>& vertices,
                 Outline outline = Outline::none);
  ~LandmarkFitter();
  LandmarkFitter(LandmarkFitter&&) noexcept;
  LandmarkFitter& operator=(LandmarkFitter&&) noexcept;

  /// Fits all frames. `points` is F x 2n: x0 y0 x1 y1 ... in pixels, y down, 0-based, NaN if not
  /// seen. `times` (F) are ascending seconds; without them frames are evenly spaced. `outline` is F
  /// x 2m in the same layout: landmarks anywhere on the outline of the face as the camera sees it.
  /// They are used only if the noise is estimated.
  ///
  /// Throws std::invalid_argument if sizes disagree or an option is out of range. Throws
  /// MismatchError if no frame has landmarks, or if a frame has fewer than four or only coplanar
  /// ones. Throws Cancelled.
  std::vector<FrameFit> fit(const Frames& points, const FitOptions& = {},
                            const Eigen::VectorXd& times = {}, const Frames& outline = {},
                            const Context& = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
