#pragma once

#include <memory>

#include <Eigen/SparseCore>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/unit_change.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// A model driven by weights; poses are computed when they are read. The rest pose is the neutral.
class Animation : public FrameSource {
 public:
  /// `weights` F x D; `times` F in seconds, or empty where nobody knows them, as is also said of
  /// those that only tell frames apart. Throws std::invalid_argument where sizes disagree.
  Animation(std::shared_ptr<const BlendshapeModel> model, Eigen::MatrixXd weights,
            Eigen::VectorXd times = {}, bool times_are_known = true);

  const BlendshapeModel& model() const { return *model_; }
  const Eigen::MatrixXd& weights() const { return weights_; }
  bool is_quick() const override { return true; }
  /// The same with its model in other units and axes. Throws std::invalid_argument for options out
  /// of range.
  Animation in_units(const UnitChange& change) const;
  /// The same on another mesh, vertex v of which is vertices[v] of this one. Throws
  /// std::invalid_argument unless there is one of them for each vertex of the connectivity.
  Animation renumbered(std::shared_ptr<const Connectivity> connectivity,
                       const std::vector<VertexIndex>& vertices) const;

 private:
  /// The same numbers as those frames of model().animate(weights()).
  void read_frames(int first, FramesView poses) const override;

  std::shared_ptr<const BlendshapeModel> model_;
  Eigen::MatrixXd weights_;
};

/// with_units() of any sequence, by which an Animation stays one.
std::shared_ptr<const FrameSource> in_units(std::shared_ptr<const FrameSource> source,
                                            const UnitChange& change);

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
