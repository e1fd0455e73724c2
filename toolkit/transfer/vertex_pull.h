#pragma once

#include <vector>

#include "toolkit/model/animation.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// What a source's deformation gradients ask of the target's vertices: at each vertex v the sum of
/// (Q_i - I) x_iv over the selected triangles i around it, with constant vectors x_iv.
///
/// Since Q_i = U~_i U_i^-1, a triangle needs its frame U~_i and the constant vectors U_i^-1 x_iv
/// only. They act on x, y and z alike. The rest pose, to which the same is done once, is taken
/// off: it gives exactly 0.
class VertexPull {
 public:
  /// So many frames at a time, side by side: one instruction serves several of them. x, y and z of
  /// sixteen fill twelve registers of AVX2, which leaves four to compute with.
  static constexpr int kLanes = 16;
  static constexpr int kWidth = 3 * kLanes;
  /// A row holds x of each frame, then y, then z.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kWidth, Eigen::RowMajor>;

  /// What the gradient of a selected triangle asks of the corners of another triangle a b c of the
  /// target: x_b and x_c; x_a = -x_b - x_c.
  struct Crossing {
    int selected;  ///< place in the gradients' list
    int triangle;
    Edges vectors;
  };

  /// `rest` N x 3 and `source` of the source, `gradients` those of `target` (M x 3) at `rest`.
  /// `vectors` holds, for each selected triangle a b c of the target, x_ib and x_ic;
  /// x_ia = -x_ib - x_ic. `row_of_vertex` says where the sum of a vertex of the target goes; -1 for
  /// nowhere. Sums that go to one row are added. `crossings` are added to them.
  VertexPull(const Positions& rest, const Triangles& source, const Triangles& target,
             const DeformationGradients& gradients, const std::vector<Edges>& vectors,
             const std::vector<int>& row_of_vertex, const std::vector<Crossing>& crossings = {});

  /// One row for each number in row_of_vertex; lanes beyond the last frame repeat it.
  /// \pre 1 <= frames.rows() <= kLanes, frames.cols() == 3N of the source
  Rows operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  /// What one source triangle does to the corners of one target triangle.
  struct Term {
    Eigen::Vector3i source, target;  // corners, as slots
    Edges factor;                    // U^-1 x_ib, U^-1 x_ic
  };

  Rows gather(const Eigen::Ref<const Frames>& frames) const;
  Rows sums(const Rows& positions) const;

  int rows_ = 0;
  std::vector<VertexIndex> vertices_;  // of the source, that terms use
  std::vector<int> row_of_slot_;       // of the target's vertices that terms use
  std::vector<Term> terms_;
  Positions at_rest_;  // sums of the rest pose
};

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
