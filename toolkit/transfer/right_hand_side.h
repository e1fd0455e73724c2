#pragma once

#include "toolkit/model/blendshape_model.h"
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

  /// `rest` N x 3, of the source; `gradients` are those of the target's triangles at `rest`.
  RightHandSide(const Positions& rest, const DeformationGradients& gradients,
                const BlendshapeModel& target, EdgeSum sum);

  /// One row a frame (F x D). \pre 1 <= frames.rows() <= kLanes, frames.cols() == 3N
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  VertexPull pull_;
  Eigen::MatrixXd basis_;  // displacements of the selected triangles' vertices
};

}  // namespace mimetra
