#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/fit_options.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// Frames during the fit, and the solvers. Internal to landmark_fitter.h.
namespace mimetra {

/// Displacements of n landmarks by the columns of a basis, with products for each pair of axes.
class BasisRows {
 public:
  using Axes = Eigen::Matrix<double, 2, 3>;

  /// `rows` is 3n x D: x of all landmarks, then y, then z.
  explicit BasisRows(Eigen::MatrixXd rows);

  Eigen::Index size() const { return rows_.cols(); }
  const Eigen::MatrixXd& rows() const { return rows_; }
  ModelPoints displacement(const Eigen::VectorXd& coefficients) const;

  /// Lower triangle of A^T A, column after column, for A (2n x D), the basis as a camera with
  /// linear part C sees it. The result is linear in M = C^T C, so frames can be summed in either.
  Eigen::VectorXd packed_gram(const Eigen::Matrix3d& M) const;
  /// A^T r for residuals r (n x 2).
  Eigen::VectorXd transposed_product(const Axes& C, const ImagePoints& r) const;

 private:
  Eigen::MatrixXd rows_;
  /// One column for each product xx, yy, zz, xy, xz, yz, packed like packed_gram().
  Eigen::Matrix<double, Eigen::Dynamic, 6> products_;
};

/// Unpacks a lower triangle into a matrix (D x D), whose upper part is not set.
Eigen::MatrixXd lower_triangle(const Eigen::VectorXd& packed, Eigen::Index size);

/// Rows of a model at n landmarks: mean, identities, expressions, and the two bases side by side.
struct LandmarkRows {
  LandmarkRows(const MorphableModel& model, const std::vector<int>& vertices);
  /// Selects the rows of some landmarks.
  LandmarkRows(const LandmarkRows& all, const std::vector<Eigen::Index>& some);

  std::vector<Eigen::Index> landmarks;  ///< indices among all landmarks, ascending
  ModelPoints mean;
  BasisRows identities;
  BasisRows expressions;
  BasisRows both;
};

/// Landmarks on the outline of the face in one frame. Each is compared with a point of the model
/// only across the outline, because it may be anywhere along it.
struct OutlineRows {
  ImagePoints image;       ///< m x 2
  ImagePoints normals;     ///< normals of the outline there, length 1
  ModelPoints mean;        ///< matched points of the mean face
  Eigen::MatrixXd basis;   ///< 3m x (identities, expressions): x of all points, then y, then z
  Eigen::VectorXd weight;  ///< weight of a squared pixel relative to a landmark's (m)
};

/// Properties of a camera that an affine one lacks.
struct CameraModel {
  /// Standard deviation of the stretch of a scaled orthographic camera; infinity for an affine one.
  double stretch = std::numeric_limits<double>::infinity();
  /// 1 / focal length in pixels; 0 for a camera at infinity.
  double nearness = 0;

  bool is_affine() const { return stretch == std::numeric_limits<double>::infinity(); }
};

/// Landmarks of one frame with the camera and coefficients that explain them so far.
class FittedFrame {
 public:
  /// Starts with alpha = 0, beta = 0 and the best camera for them. `image` (n x 2) has the
  /// landmarks of `rows`.
  FittedFrame(std::shared_ptr<const LandmarkRows> rows, ImagePoints image, double sigma,
              const CameraModel& model = {});

  const LandmarkRows& rows() const { return *rows_; }
  const ImagePoints& image() const { return image_; }
  /// RMS distance of the landmarks from their centroid, in pixels.
  double radius() const { return radius_; }
  double sigma() const { return sigma_; }
  /// Weight of a squared pixel in the energy: 1 / (2 sigma^2).
  double weight() const { return 1 / (2 * sigma_ * sigma_); }
  /// Weight of each landmark (n).
  const Eigen::VectorXd& landmark_weights() const { return landmark_weights_; }
  const AffineCamera& camera() const { return camera_; }
  /// Third row of the camera's matrix; (0, 0, 0, 1) for a camera at infinity.
  Eigen::RowVector4d depth_row() const;
  const Eigen::VectorXd& alpha() const { return alpha_; }
  const Eigen::VectorXd& beta() const { return beta_; }

  void set_sigma(double sigma) { sigma_ = sigma; }
  void set_landmark_weights(Eigen::VectorXd weights) { landmark_weights_ = std::move(weights); }
  /// Landmarks on the outline, or null.
  const std::shared_ptr<const OutlineRows>& outline() const { return outline_; }
  void set_outline(std::shared_ptr<const OutlineRows> outline) { outline_ = std::move(outline); }
  void set_alpha(const Eigen::VectorXd& alpha);
  void set_beta(const Eigen::VectorXd& beta);
  /// Finds the best camera for alpha and beta: in closed form, or starting from the present one.
  void estimate_camera();

  ModelPoints points() const { return rows_->mean + identity_ + expression_; }
  /// Landmarks minus their projections (n x 2), with both bases or without one of them.
  ImagePoints residual() const;
  ImagePoints residual_without_identity() const;
  ImagePoints residual_without_expression() const;
  /// Distance of the outline's landmarks from the outline, across it (m), in pixels.
  Eigen::VectorXd outline_residual() const;

  ImagePoints projected(const ModelPoints& points) const;

  /// Weighted sum of squares: residuals of landmarks and outline, and stretch of the camera.
  double misfit() const;

  /// The misfit as |residual - directions * change|^2 for a small change of camera or coefficients.
  struct Linear {
    Eigen::VectorXd residual;
    Eigen::MatrixXd camera;  ///< by the eight numbers of the camera, row after row
    Eigen::MatrixXd basis;   ///< by (alpha, beta)
  };
  Linear linear() const;

 private:
  ModelPoints outline_points() const;
  /// Scale (n) at the distance of each point from the camera: 1 at the model's origin.
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

/// Noise model of a clip. The error of a landmark, in each direction and as a share of the face's
/// RMS radius, is the sum of two parts. One part is the same in every frame, on the face as it
/// turns in the image. The other part is independent. Both have Student's t distribution.
struct ClipNoise {
  double sigma = 0;     ///< sigma of both parts together
  double repeated = 0;  ///< rho, the share of sigma^2 that is the same in every frame
  double freedom = 6;   ///< nu of the distribution; lower values allow more outliers
  double outline = 0;   ///< sigma of landmarks on the outline, across it

  /// Number of independent frames with as much information on shared parameters as `frames`.
  double independent_frames(double frames) const { return frames / (1 + (frames - 1) * repeated); }
  /// Weight of the square of an error that has `coordinates` coordinates and is `z` sigmas long.
  double weight(double z, int coordinates) const {
    return (freedom + coordinates) / (freedom + z * z);
  }
};

/// Frames that were fitted together, with the course of the fit.
struct FittedClip {
  std::vector<FittedFrame> frames;
  int iterations = 0;
  std::vector<double> energies;
  ClipNoise noise = {};
};

/// Energy of frames, without the smoothness term. `one_identity` means that all frames share one
/// alpha. `ridge` is the weight of |beta|^2, `prior` the weight of |alpha|^2.
double energy(const std::vector<FittedFrame>& frames, bool one_identity, double ridge,
              double prior = 1);

/// True if the energy fell by less than the share `tolerance` from `before` to `after`.
bool has_converged(double before, double after, double tolerance);

/// Runs the paper's alternation from the present state of the frames. \pre options.ridge is set
FittedClip fit_alternating(std::vector<FittedFrame> frames, const FitOptions& options,
                           const Context& context = {});

/// Runs the alternation with options.smoothness. `times` are the times of the frames.
FittedClip fit_smoothly(std::vector<FittedFrame> frames, const FitOptions& options,
                        const Eigen::VectorXd& times, const Context& context = {});

struct ClipOutline;  // face_outline.h

/// Takes Gauss-Newton steps in the cameras, the shared alpha and the box-constrained betas. Between
/// steps it estimates the noise, unless that is known, and matches the outline's landmarks again.
/// The energies are for the final noise. \pre options.ridge is set
FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options,
                       const ClipOutline& outline, const Context& context = {});

/// Smooths jointly fitted frames by options.smoothness. `times` are the times of the frames. Beta
/// and cameras change; alpha and the noise stay.
FittedClip smoothed(std::vector<FittedFrame> frames, const FitOptions& options,
                    const Eigen::VectorXd& times, const Context& context = {});

}  // namespace mimetra
