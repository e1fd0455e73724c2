#pragma once

#include <memory>

#include <Eigen/SparseCore>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// How much each of some regions counts at each vertex (N x R): shares that are not negative, and
/// in each row add up to 1.
using RegionShares = Eigen::SparseMatrix<double>;

/// A model whose regions have weights of their own: pose(v) = neutral(v) + sum_r share_r(v)
/// sum_j beta_rj dV_j(v). Poses are computed when they are read. The rest pose is the neutral.
class RegionalAnimation : public FrameSource {
 public:
  /// `shares` N x R; `weights` F x R D, column r D + j is that of expression j in region r. `times`
  /// as in Animation. Throws std::invalid_argument where sizes disagree.
  RegionalAnimation(std::shared_ptr<const BlendshapeModel> model, const RegionShares& shares,
                    Eigen::MatrixXd weights, Eigen::VectorXd times = {},
                    bool times_are_known = true);

  const BlendshapeModel& model() const { return *model_; }
  const RegionShares& shares() const { return shares_; }
  const Eigen::MatrixXd& weights() const { return weights_; }

 private:
  void read_frames(int first, FramesView poses) const override;

  std::shared_ptr<const BlendshapeModel> model_;
  RegionShares shares_;
  Eigen::MatrixXd weights_;
};

}  // namespace mimetra
