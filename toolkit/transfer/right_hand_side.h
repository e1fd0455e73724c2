#pragma once

#include <vector>

#include "toolkit/model/regional_animation.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {

/// The right-hand side A^T b of eq. 11.
///
/// With D_ij the edges of expression j, h_j = sum_i <(Q_i - I) V_i G, D_ij> with the G of
/// edge_product(). An edge is a difference
/// of two vertices: gathered there, the (Q_i - I) V_i are one vector a vertex, whatever the number
/// of expressions, and h is its product with the displacement fields. Only differences to the rest
/// pose occur, so the rest gives exactly 0.
class RightHandSide {
 public:
  static constexpr int kLanes = VertexPull::kLanes;

  /// `rest` N x 3, of the source; `gradients` are those of the target's triangles at `rest`. Where
  /// `weights` are given, the square of triangle i counts weights[i] times (M).
  RightHandSide(const Positions& rest, const DeformationGradients& gradients,
                const BlendshapeModel& target, EdgeSum sum, const Eigen::VectorXd& weights = {});

  /// One row a frame (F x D). \pre 1 <= frames.rows() <= kLanes, frames.cols() == 3N of the source
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  VertexPull pull_;
  Eigen::MatrixXd basis_;  // displacements of the selected triangles' vertices
};

/// The same where each of some regions has weights of its own: h_(r,j) is the product of the
/// vectors at the vertices, each times the region's share there, with displacement field j.
class RegionalRightHandSide {
 public:
  static constexpr int kLanes = VertexPull::kLanes;

  /// As RightHandSide; `shares` N x R of the target's vertices. Keeps a reference to the target.
  RegionalRightHandSide(const Positions& rest, const DeformationGradients& gradients,
                        const BlendshapeModel& target, const RegionShares& shares, EdgeSum sum);

  /// One row a frame (F x R D), column r D + j. \pre as RightHandSide
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  /// A vertex of a region: its row among the sums, and the region's share.
  struct Held {
    VertexIndex vertex;
    int row;
    double share;
  };

  const Eigen::MatrixXd& fields_;
  VertexPull pull_;
  std::vector<std::vector<Held>> held_;  // of each region
};

/// What eq. 10 needs of frames whose head turns by rotations that are not known yet.
///
/// With p_v the sums that VertexPull gathers, x_0 the neutral from its centre and x_k the field of
/// expression k: M_k = sum_v p_v x_kv^T (3 x 3). Turning all gradients by R^T turns p_v, so that
/// A^T b and the rotation that fits best follow from the M_k, without another pass over the mesh.
class RotationMoments {
 public:
  static constexpr int kLanes = VertexPull::kLanes;
  /// M_0 M_1 ... M_D side by side.
  using Moments = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  /// As RightHandSide.
  RotationMoments(const Positions& rest, const DeformationGradients& gradients,
                  const BlendshapeModel& target, EdgeSum sum);

  /// Of each frame, less those of the rest pose. \pre as RightHandSide
  std::vector<Moments> operator()(const Eigen::Ref<const Frames>& frames) const;
  /// Of the rest pose.
  const Moments& at_rest() const { return at_rest_; }

 private:
  VertexPull pull_;
  Eigen::MatrixXd fields_;  // x_0 x_1 ... at the selected triangles' vertices, three columns each
  Moments at_rest_;
};

}  // namespace mimetra
