#include "toolkit/model/animation.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace mimetra {

namespace {

/// Header for `frames` frames of a model, with or without times.
SequenceHeader header_at(const BlendshapeModel& model, Eigen::Index frames, Eigen::VectorXd times,
                         bool times_are_known) {
  times_are_known = times_are_known && times.size() > 0;
  if (times.size() == 0) times = default_times(static_cast<int>(frames));
  if (times.size() != frames) {
    throw std::invalid_argument(std::to_string(times.size()) + " times for " +
                                std::to_string(frames) + " frames");
  }
  return {model.shared_connectivity(), std::move(times), model.neutral(), true, times_are_known};
}

SequenceHeader header_of(const BlendshapeModel& model, const Eigen::MatrixXd& weights,
                         Eigen::VectorXd times, bool times_are_known) {
  if (weights.cols() != model.expressions().size()) {
    throw std::invalid_argument(std::to_string(weights.cols()) + " weights for a model of " +
                                std::to_string(model.expressions().size()) + " expressions");
  }
  return header_at(model, weights.rows(), std::move(times), times_are_known);
}

SequenceHeader header_of(const BlendshapeModel& model, const RegionShares& shares,
                         const Eigen::MatrixXd& weights, Eigen::VectorXd times,
                         bool times_are_known) {
  if (shares.rows() != model.vertices()) {
    throw std::invalid_argument("shares of " + std::to_string(shares.rows()) +
                                " vertices for a model of " + std::to_string(model.vertices()));
  }
  if (weights.cols() != shares.cols() * model.expressions().size()) {
    throw std::invalid_argument(std::to_string(weights.cols()) + " weights for " +
                                std::to_string(shares.cols()) + " regions and " +
                                std::to_string(model.expressions().size()) + " expressions");
  }
  return header_at(model, weights.rows(), std::move(times), times_are_known);
}

}  // namespace

Animation::Animation(std::shared_ptr<const BlendshapeModel> model, Eigen::MatrixXd weights,
                     Eigen::VectorXd times, bool times_are_known)
    : FrameSource(header_of(*model, weights, std::move(times), times_are_known)),
      model_(std::move(model)),
      weights_(std::move(weights)) {}

Animation Animation::in_units(const UnitChange& change) const {
  check_options(change);
  Animation changed = *this;
  changed.header_ = mimetra::in_units(header_, change);
  Positions neutral = model_->neutral();
  change_units(neutral, change);
  ShapeBasis shapes = model_->expressions();
  for (int j = 0; j < shapes.size(); ++j) {
    change_units(Eigen::Map<Positions>(shapes.displacements.col(j).data(), neutral.rows(), 3),
                 change);
  }
  changed.model_ = std::make_shared<const BlendshapeModel>(model_->shared_connectivity(),
                                                           std::move(neutral), std::move(shapes));
  return changed;
}

Animation Animation::renumbered(std::shared_ptr<const Connectivity> connectivity,
                                const std::vector<VertexIndex>& vertices) const {
  const ShapeBasis& given = model_->expressions();
  const auto count = static_cast<Eigen::Index>(vertices.size());
  ShapeBasis shapes{given.names, Eigen::MatrixXd(3 * count, given.size())};
  for (int j = 0; j < given.size(); ++j) {
    const Eigen::Map<const Positions> from(given.displacements.col(j).data(), model_->vertices(),
                                           3);
    Eigen::Map<Positions>(shapes.displacements.col(j).data(), count, 3) =
        from(vertices, Eigen::all);
  }
  const Positions neutral = model_->neutral()(vertices, Eigen::all);
  return Animation(
      std::make_shared<const BlendshapeModel>(std::move(connectivity), neutral, std::move(shapes)),
      weights_, times(), times_are_known());
}

void Animation::read_frames(int first, FramesView poses) const {
  // A product computes four columns (here frames) at a time and the rest one by one, which adds in
  // another order. A single column takes yet another path. Runs that begin and end at a multiple of
  // four, or end at the last frame, see the same numbers as the whole.
  constexpr int kFrames = 4;
  const int last = first + static_cast<int>(poses.rows());
  const int end = std::min(frames(), (last + kFrames - 1) / kFrames * kFrames);
  const int start =
      std::max(0, std::min(first / kFrames * kFrames, end / kFrames * kFrames - kFrames));
  const MeshSequence run = model_->animate(weights_.middleRows(start, end - start));
  poses = run.positions().middleRows(first - start, poses.rows());
}

std::shared_ptr<const FrameSource> in_units(std::shared_ptr<const FrameSource> source,
                                            const UnitChange& change) {
  const auto* animation = dynamic_cast<const Animation*>(source.get());
  if (!animation || (change.scale == 1 && change.up == UpTurn::keep)) {
    return with_units(std::move(source), change);
  }
  return std::make_shared<const Animation>(animation->in_units(change));
}

RegionalAnimation::RegionalAnimation(std::shared_ptr<const BlendshapeModel> model,
                                     const RegionShares& shares, Eigen::MatrixXd weights,
                                     Eigen::VectorXd times, bool times_are_known)
    : FrameSource(header_of(*model, shares, weights, std::move(times), times_are_known)),
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
    // any run of frames gives the same result.
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
