#pragma once

#include <memory>
#include <vector>

#include "fitting/fit_options.h"
#include "fitting/landmark_rows.h"

/// Frames while they are being fitted. Internal to landmark_fitter.h.
namespace mimetra {

/// The landmarks of one frame and what explains them so far.
class FittedFrame {
 public:
  /// Starts at alpha = 0, beta = 0 and the camera for them. `image` n x 2, the landmarks of `rows`.
  FittedFrame(std::shared_ptr<const LandmarkRows> rows, ImagePoints image, double sigma);

  const LandmarkRows& rows() const { return *rows_; }
  const ImagePoints& image() const { return image_; }
  double sigma() const { return sigma_; }
  /// Of a squared pixel in the energy: 1 / (2 sigma^2).
  double weight() const { return 1 / (2 * sigma_ * sigma_); }
  const AffineCamera& camera() const { return camera_; }
  const Eigen::VectorXd& alpha() const { return alpha_; }
  const Eigen::VectorXd& beta() const { return beta_; }

  void set_alpha(const Eigen::VectorXd& alpha);
  void set_beta(const Eigen::VectorXd& beta);
  void estimate_camera();

  ModelPoints points() const { return rows_->mean + identity_ + expression_; }
  /// What is left of the landmarks (n x 2) by all that is known, or all but one of the bases.
  ImagePoints residual() const { return image_ - project(camera_, points()); }
  ImagePoints residual_without_identity() const;
  ImagePoints residual_without_expression() const;

 private:
  std::shared_ptr<const LandmarkRows> rows_;
  ImagePoints image_;
  double sigma_;
  AffineCamera camera_;
  Eigen::VectorXd alpha_, beta_;
  ModelPoints identity_, expression_;  // displacements by alpha and by beta
};

/// Frames that were fitted together, and how that went.
struct FittedClip {
  std::vector<FittedFrame> frames;
  int iterations = 0;
  std::vector<double> energies;
};

/// Of frames with one alpha, without the smoothness term. `ridge` is the weight of |beta|^2.
double energy(const std::vector<FittedFrame>& frames, bool one_identity, double ridge);

/// True where an energy that fell from `before` to `after` has fallen by less than `tolerance`.
bool has_converged(double before, double after, double tolerance);

/// The paper's alternation, from where the frames are. `options.ridge` is set.
FittedClip fit_alternating(std::vector<FittedFrame> frames, const FitOptions& options);

/// The alternation with options.smoothness; `times` belong to the frames.
FittedClip fit_smoothly(std::vector<FittedFrame> frames, const FitOptions& options,
                        const Eigen::VectorXd& times);

/// Gauss-Newton on cameras, the one alpha of the frames, and beta within its box. `options.ridge`
/// is set.
FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options);

}  // namespace mimetra
