#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/fit_options.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// Frames while they are being fitted, and the solvers. Internal to landmark_fitter.h.
namespace mimetra {

/// Displacements of n landmarks by the columns of a basis, and their products in pairs of axes.
class BasisRows {
 public:
  using Axes = Eigen::Matrix<double, 2, 3>;

  /// `rows` 3n x D: x of all landmarks, then y, then z.
  explicit BasisRows(Eigen::MatrixXd rows);

  Eigen::Index size() const { return rows_.cols(); }
  const Eigen::MatrixXd& rows() const { return rows_; }
  ModelPoints displacement(const Eigen::VectorXd& coefficients) const;

  /// A^T A for A (2n x D), what a camera with the linear part C sees of the basis: lower triangle,
  /// column after column. It is linear in M = C^T C: sums over frames go into M, or over these.
  Eigen::VectorXd packed_gram(const Eigen::Matrix3d& M) const;
  /// A^T r for residuals r (n x 2).
  Eigen::VectorXd transposed_product(const Axes& C, const ImagePoints& r) const;

 private:
  Eigen::MatrixXd rows_;
  /// One column for each of the products xx, yy, zz, xy, xz, yz, packed like packed_gram().
  Eigen::Matrix<double, Eigen::Dynamic, 6> products_;
};

/// The symmetric matrix (D x D) of a packed lower triangle; its upper part is not set.
Eigen::MatrixXd lower_triangle(const Eigen::VectorXd& packed, Eigen::Index size);

/// A model at n landmarks: mean, identities, expressions and both side by side.
struct LandmarkRows {
  LandmarkRows(const MorphableModel& model, const std::vector<int>& vertices);
  /// Those of some landmarks only.
  LandmarkRows(const LandmarkRows& all, const std::vector<Eigen::Index>& some);

  std::vector<Eigen::Index> landmarks;  ///< which of all they are, ascending
  ModelPoints mean;
  BasisRows identities;
  BasisRows expressions;
  BasisRows both;
};

/// Landmarks that lie on the outline of the face as one frame sees it: each is compared with a
/// point of the model across the outline only, because it may be anywhere along it.
struct OutlineRows {
  ImagePoints image;       ///< m x 2
  ImagePoints normals;     ///< of the outline there, length 1
  ModelPoints mean;        ///< of the model's points
  Eigen::MatrixXd basis;   ///< 3m x (identities, expressions): x of all points, then y, then z
  Eigen::VectorXd weight;  ///< of a squared pixel beside one of a landmark (m)
};

/// What a frame's camera is beyond an affine one.
struct CameraModel {
  /// Standard deviation of the stretch of a scaled orthographic camera; infinity for an affine one.
  double stretch = std::numeric_limits<double>::infinity();
  /// 1 / focal length in pixels; 0 seen from afar.
  double nearness = 0;

  bool is_affine() const { return stretch == std::numeric_limits<double>::infinity(); }
};

/// The landmarks of one frame and what explains them so far.
class FittedFrame {
 public:
  /// Starts at alpha = 0, beta = 0 and the camera for them. `image` n x 2, the landmarks of `rows`.
  FittedFrame(std::shared_ptr<const LandmarkRows> rows, ImagePoints image, double sigma,
              const CameraModel& model = {});

  const LandmarkRows& rows() const { return *rows_; }
  const ImagePoints& image() const { return image_; }
  /// RMS distance of the landmarks from their centroid, in pixels.
  double radius() const { return radius_; }
  double sigma() const { return sigma_; }
  /// Of a squared pixel in the energy: 1 / (2 sigma^2).
  double weight() const { return 1 / (2 * sigma_ * sigma_); }
  /// Of each landmark, in [0, 1] (n).
  const Eigen::VectorXd& landmark_weights() const { return landmark_weights_; }
  const AffineCamera& camera() const { return camera_; }
  /// The third row of the camera's matrix, (0, 0, 0, 1) seen from afar.
  Eigen::RowVector4d depth_row() const;
  const Eigen::VectorXd& alpha() const { return alpha_; }
  const Eigen::VectorXd& beta() const { return beta_; }

  void set_sigma(double sigma) { sigma_ = sigma; }
  void set_landmark_weights(Eigen::VectorXd weights) { landmark_weights_ = std::move(weights); }
  /// Of the landmarks on the outline, or null.
  const std::shared_ptr<const OutlineRows>& outline() const { return outline_; }
  void set_outline(std::shared_ptr<const OutlineRows> outline) { outline_ = std::move(outline); }
  void set_alpha(const Eigen::VectorXd& alpha);
  void set_beta(const Eigen::VectorXd& beta);
  /// The best camera for alpha and beta: in closed form, or from the one that is there.
  void estimate_camera();

  ModelPoints points() const { return rows_->mean + identity_ + expression_; }
  /// What is left of the landmarks (n x 2) by all that is known, or all but one of the bases.
  ImagePoints residual() const;
  ImagePoints residual_without_identity() const;
  ImagePoints residual_without_expression() const;
  /// What is left of the outline's landmarks across it (m), in pixels.
  Eigen::VectorXd outline_residual() const;

  /// Where the camera sees points of the model.
  ImagePoints projected(const ModelPoints& points) const;

  /// Weighted squares of what is left of landmarks and outline, and of the camera's stretch.
  double misfit() const;

  /// The misfit as |residual - directions * change|^2 for a small change of what it depends on.
  struct Linear {
    Eigen::VectorXd residual;
    Eigen::MatrixXd camera;  ///< of its eight numbers, row after row
    Eigen::MatrixXd basis;   ///< of (alpha, beta)
  };
  Linear linear() const;

 private:
  ModelPoints outline_points() const;
  /// Of points at their distance from the camera: 1 at the model's origin.
  Eigen::VectorXd shrinking(const ModelPoints& points) const;
  Linear camera_only() const;

  std::shared_ptr<const LandmarkRows> rows_;
  std::shared_ptr<const OutlineRows> outline_;
  ImagePoints image_;
  double radius_, sigma_;
  CameraModel model_;
  Eigen::VectorXd landmark_weights_;
  AffineCamera camera_;
  Eigen::VectorXd alpha_, beta_;
  ModelPoints identity_, expression_;  // displacements by alpha and by beta
};

/// A landmark's error, in each direction and as a share of the face's RMS radius in its frame, is
/// the sum of one that is the same in every frame, on the face as it turns in the image, and one of
/// its own, both of Student's t distribution.
struct ClipNoise {
  double sigma = 0;     ///< of both together
  double repeated = 0;  ///< share of sigma^2 that is the same in every frame: rho
  double freedom = 6;   ///< nu of the distribution: the lower, the more lie far off
  double outline = 0;   ///< sigma of landmarks on the outline, across it

  /// Of how many frames that are independent F of them say as much about what they share.
  double independent_frames(double frames) const { return frames / (1 + (frames - 1) * repeated); }
  /// Of the square of an error of so many coordinates that is `z` sigmas long.
  double weight(double z, int coordinates) const {
    return (freedom + coordinates) / (freedom + z * z);
  }
};

/// Frames that were fitted together, and how that went.
struct FittedClip {
  std::vector<FittedFrame> frames;
  int iterations = 0;
  std::vector<double> energies;
  ClipNoise noise = {};
};

/// Of frames with one alpha, without the smoothness term. `ridge` is the weight of |beta|^2,
/// `prior` that of |alpha|^2.
double energy(const std::vector<FittedFrame>& frames, bool one_identity, double ridge,
              double prior = 1);

/// True where an energy that fell from `before` to `after` has fallen by less than `tolerance`.
bool has_converged(double before, double after, double tolerance);

/// The paper's alternation, from where the frames are. `options.ridge` is set.
FittedClip fit_alternating(std::vector<FittedFrame> frames, const FitOptions& options,
                           const Context& context = {});

/// The alternation with options.smoothness; `times` belong to the frames.
FittedClip fit_smoothly(std::vector<FittedFrame> frames, const FitOptions& options,
                        const Eigen::VectorXd& times, const Context& context = {});

struct ClipOutline;  // face_outline.h

/// Gauss-Newton on cameras, the one alpha of the frames, and beta within its box; between steps the
/// noise is estimated, unless it is known, and landmarks on the outline are matched to it anew.
/// `options.ridge` is set. The energies are those of the last noise.
FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options,
                       const ClipOutline& outline, const Context& context = {});

/// Adds options.smoothness to frames that were fitted jointly, at `times`: beta and cameras change,
/// the one alpha and the noise stay.
FittedClip smoothed(std::vector<FittedFrame> frames, const FitOptions& options,
                    const Eigen::VectorXd& times, const Context& context = {});

}  // namespace mimetra
