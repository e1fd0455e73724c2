#include "fitting/fitted_frame.h"

#include <utility>

namespace mimetra {

FittedFrame::FittedFrame(std::shared_ptr<const LandmarkRows> rows, ImagePoints image, double sigma)
    : rows_(std::move(rows)), image_(std::move(image)), sigma_(sigma) {
  set_alpha(Eigen::VectorXd::Zero(rows_->identities.size()));
  set_beta(Eigen::VectorXd::Zero(rows_->expressions.size()));
  estimate_camera();
}

void FittedFrame::set_alpha(const Eigen::VectorXd& alpha) {
  alpha_ = alpha;
  identity_ = rows_->identities.displacement(alpha);
}

void FittedFrame::set_beta(const Eigen::VectorXd& beta) {
  beta_ = beta;
  expression_ = rows_->expressions.displacement(beta);
}

void FittedFrame::estimate_camera() {
  camera_ = estimate_affine_camera(points(), image_);
}

ImagePoints FittedFrame::residual_without_identity() const {
  return image_ - project(camera_, rows_->mean + expression_);
}

ImagePoints FittedFrame::residual_without_expression() const {
  return image_ - project(camera_, rows_->mean + identity_);
}

double energy(const std::vector<FittedFrame>& frames, bool one_identity, double ridge) {
  double sum = one_identity ? frames.front().alpha().squaredNorm() : 0;
  for (const FittedFrame& frame : frames) {
    sum += frame.weight() * frame.residual().squaredNorm() + ridge * frame.beta().squaredNorm();
    if (!one_identity) sum += frame.alpha().squaredNorm();
  }
  return sum;
}

bool has_converged(double before, double after, double tolerance) {
  return before - after < tolerance * before;
}

}  // namespace mimetra
