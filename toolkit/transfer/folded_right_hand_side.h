#pragma once

#include <vector>

#include <mimetra/model/blendshape_model.h>
#include <mimetra/transfer/deformation_gradients.h>

namespace mimetra {

/// The right-hand side A^T b of eq. 11 as two constant matrices, one acting on displacements of the
/// source's vertices, one on the changes of its scaled triangle normals.
///
/// With D_ij the edges of expression j, h_j = sum_i <(Q_i - I) V_i, D_ij>. Since Q_i - I =
/// (U~_i - U_i) U_i^-1, this is sum_i <U~_i - U_i, M_ij> with the constant M_ij = D_ij V_i^T
/// U_i^-T. Columns 1 and 2 of U~_i are vertex differences and gather at the vertices; column 3
/// stays with its triangle. Only differences to the rest pose occur, so the rest gives exactly 0.
class FoldedRightHandSide {
 public:
  /// `rest` N x 3, of the source; `gradients` are those of `triangles` (M x 3) at `rest`.
  FoldedRightHandSide(const Positions& rest, const Triangles& triangles,
                      const DeformationGradients& gradients, const BlendshapeModel& target);

  /// One row a frame (F x D). \pre frames.cols() == 3N
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  /// So many frames at a time, side by side: one instruction serves several of them.
  static constexpr int kLanes = 8;
  using Lane = Eigen::Array<double, 1, kLanes>;
  using Lanes = Eigen::Matrix<double, Eigen::Dynamic, kLanes, Eigen::RowMajor>;

  void number(const Triangles& triangles, const DeformationGradients& gradients);
  void fold(const Triangles& triangles, const DeformationGradients& gradients,
            const BlendshapeModel& target);
  Lanes gather(const Eigen::Ref<const Frames>& frames, int first) const;
  void normals(const Lanes& positions, int first, int count, Lanes& result) const;

  std::vector<VertexIndex> vertices_;  // those that the source triangles use
  std::vector<int> vertex_slot_;       // of each vertex; -1 where it is not used
  Triangles corners_;                  // of each source triangle, as slots
  std::vector<int> triangle_slot_;     // of each triangle; -1 where it is no source
  Eigen::MatrixXd on_positions_;       // D x 3 |vertices_|
  Eigen::MatrixXd on_normals_;         // D x 3 |corners_|
  Eigen::VectorXd rest_;               // positions of vertices_
  Eigen::VectorXd rest_normals_;
};

}  // namespace mimetra
