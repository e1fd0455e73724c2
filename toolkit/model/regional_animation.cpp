#include "toolkit/model/regional_animation.h"

#include <stdexcept>
#include <string>

namespace mimetra {
namespace {

SequenceHeader regional_header(const BlendshapeModel& model, const RegionShares& shares,
                               const Eigen::MatrixXd& weights, Eigen::VectorXd times,
                               bool times_are_known) {
  const Eigen::Index expected = shares.cols() * model.expressions().size();
  if (shares.rows() != model.vertices()) {
    throw std::invalid_argument("shares of " + std::to_string(shares.rows()) +
                                " vertices for a model of " + std::to_string(model.vertices()));
  }
  if (weights.cols() != expected) {
    throw std::invalid_argument(std::to_string(weights.cols()) + " weights for " +
                                std::to_string(shares.cols()) + " regions and " +
                                std::to_string(model.expressions().size()) + " expressions");
  }
  times_are_known = times_are_known && times.size() > 0;
  if (times.size() == 0) times = default_times(static_cast<int>(weights.rows()));
  if (times.size() != weights.rows()) {
    throw std::invalid_argument(std::to_string(times.size()) + " times for " +
                                std::to_string(weights.rows()) + " frames");
  }
  return {model.shared_connectivity(), std::move(times), model.neutral(), true, times_are_known};
}

}  // namespace

RegionalAnimation::RegionalAnimation(std::shared_ptr<const BlendshapeModel> model,
                                     const RegionShares& shares, Eigen::MatrixXd weights,
                                     Eigen::VectorXd times, bool times_are_known)
    : FrameSource(regional_header(*model, shares, weights, std::move(times), times_are_known)),
      model_(std::move(model)),
      shares_(shares),
      weights_(std::move(weights)) {}

void RegionalAnimation::read_frames(int first, FramesView poses) const {
  const Eigen::MatrixXd& fields = model_->expressions().displacements;
  const Eigen::Index D = fields.cols();
  const auto neutral = model_->neutral().reshaped<Eigen::RowMajor>();
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    poses.row(row) = neutral.transpose();
    // Each number is added up in one order, expression by expression and region by region, so that
    // any run of frames gives the same.
    Eigen::VectorXd at_vertex(model_->vertices());
    for (Eigen::Index j = 0; j < D; ++j) {
      at_vertex.setZero();
      for (Eigen::Index r = 0; r < shares_.cols(); ++r) {
        const double weight = weights_(first + row, r * D + j);
        if (weight == 0) continue;
        for (RegionShares::InnerIterator share(shares_, r); share; ++share) {
          at_vertex[share.index()] += weight * share.value();
        }
      }
      for (Eigen::Index v = 0; v < at_vertex.size(); ++v) {
        if (at_vertex[v] == 0) continue;
        for (int c = 0; c < 3; ++c) poses(row, 3 * v + c) += at_vertex[v] * fields(3 * v + c, j);
      }
    }
  }
}

}  // namespace mimetra
