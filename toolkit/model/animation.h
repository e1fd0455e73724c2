#pragma once

#include <memory>

#include <Eigen/SparseCore>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/unit_change.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// A model driven by weights. Poses are computed when they are read; the rest pose is the neutral.
class Animation : public FrameSource {
 public:
  /// `weights` F x D; `times` F in seconds, or empty if they are unknown. Pass false for
  /// `times_are_known` if the times only number the frames. Throws std::invalid_argument if sizes
  /// disagree.
  Animation(std::shared_ptr<const BlendshapeModel> model, Eigen::MatrixXd weights,
            Eigen::VectorXd times = {}, bool times_are_known = true);

  const BlendshapeModel& model() const { return *model_; }
  const Eigen::MatrixXd& weights() const { return weights_; }
  bool is_quick() const override { return true; }
  /// The animation with its model in other units and axes. Throws std::invalid_argument for options
  /// out of range.
  Animation in_units(const UnitChange& change) const;
  /// The animation on another mesh, whose vertex v is vertices[v] of this one. Throws
  /// std::invalid_argument unless `vertices` has one entry for each vertex of the connectivity.
  Animation renumbered(std::shared_ptr<const Connectivity> connectivity,
                       const std::vector<VertexIndex>& vertices) const;

 private:
  /// Reads the same numbers as model().animate(weights()) has in those frames.
  void read_frames(int first, FramesView poses) const override;

  std::shared_ptr<const BlendshapeModel> model_;
  Eigen::MatrixXd weights_;
};

/// Returns with_units() of any sequence. An Animation stays an Animation.
std::shared_ptr<const FrameSource> in_units(std::shared_ptr<const FrameSource> source,
                                            const UnitChange& change);

/// Share of each region at each vertex (N x R): not negative, and each row adds up to 1.
using RegionShares = Eigen::SparseMatrix<double>;

/// A model with separate weights for each region: pose(v) = neutral(v) + sum_r share_r(v) sum_j
/// beta_rj dV_j(v). Poses are computed when they are read; the rest pose is the neutral.
class RegionalAnimation : public FrameSource {
 public:
  /// `shares` N x R; `weights` F x R D, where column r D + j belongs to expression j in region r.
  /// `times` as in Animation. Throws std::invalid_argument if sizes disagree.
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
