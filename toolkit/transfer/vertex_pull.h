#pragma once

#include <vector>

#include "toolkit/model/animation.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// Pull of a source's deformation gradients on the target's vertices. At vertex v, it is the sum of
/// (Q_i - I) x_iv over the selected triangles i around v, with constant vectors x_iv.
///
/// Since Q_i = U~_i U_i^-1, a triangle needs only its frame U~_i and the constant vectors U_i^-1
/// x_iv, which act on x, y and z alike. The sums of the rest pose are computed once and subtracted,
/// so that it gives exactly 0.
class VertexPull {
 public:
  /// Number of frames that are processed side by side, so that one instruction serves several. x, y
  /// and z of sixteen frames fill twelve registers of AVX2, and four remain for computing.
  static constexpr int kLanes = 16;
  static constexpr int kWidth = 3 * kLanes;
  /// Each row holds x of every frame, then y, then z.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kWidth, Eigen::RowMajor>;

  /// Action of a selected triangle's gradient on the corners of another target triangle a b c.
  /// `vectors` are x_b and x_c; x_a = -x_b - x_c.
  struct Crossing {
    int selected;  ///< position in the gradients' list of selected triangles
    int triangle;
    Edges vectors;
  };

  /// `rest` (N x 3) and `source` belong to the source. `gradients` are for triangles of `target`
  /// (M x 3), taken at `rest`. `vectors` holds x_ib and x_ic for each selected triangle a b c of
  /// the target; x_ia = -x_ib - x_ic. `row_of_vertex` maps a vertex of the target to the row of its
  /// sum, or to -1 for none. Vertices of one row are summed. `crossings` are added to the same
  /// rows.
  VertexPull(const Positions& rest, const Triangles& source, const Triangles& target,
             const DeformationGradients& gradients, const std::vector<Edges>& vectors,
             const std::vector<int>& row_of_vertex, const std::vector<Crossing>& crossings = {});

  /// One row for each number in row_of_vertex. Lanes beyond the last frame repeat it.
  /// \pre 1 <= frames.rows() <= kLanes, frames.cols() == 3N of the source
  Rows operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  /// Action of one source triangle on the corners of one target triangle.
  struct Term {
    Eigen::Vector3i source, target;  // slots of the corners
    Edges factor;                    // U^-1 x_ib, U^-1 x_ic
  };

  Rows gather(const Eigen::Ref<const Frames>& frames) const;
  Rows sums(const Rows& positions) const;

  int rows_ = 0;
  std::vector<VertexIndex> vertices_;  // source vertices that terms use
  std::vector<int> row_of_slot_;       // row of each target vertex that terms use
  std::vector<Term> terms_;
  Positions at_rest_;  // sums for the rest pose
};

/// Right-hand side A^T b of eq. 11.
///
/// h_j = sum_i <(Q_i - I) V_i G, D_ij>, with the edges D_ij of expression j and G = edge_product().
/// An edge is a difference of two vertices, so the (Q_i - I) V_i G are summed into one vector a
/// vertex, whatever the number of expressions. h is the product of these vectors with the
/// displacement fields. Only differences from the rest pose occur, so that the rest pose gives
/// exactly 0.
class RightHandSide {
 public:
  static constexpr int kLanes = VertexPull::kLanes;

  /// `rest` (N x 3) belongs to the source, and `gradients` are for triangles of the target. If
  /// `weights` (M) are given, the square of triangle i is multiplied by weights[i].
  RightHandSide(const Positions& rest, const DeformationGradients& gradients,
                const BlendshapeModel& target, EdgeSum sum, const Eigen::VectorXd& weights = {});

  /// One row a frame (F x D). \pre 1 <= frames.rows() <= kLanes, frames.cols() == 3N of the source
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  VertexPull pull_;
  Eigen::MatrixXd basis_;  // displacements of the selected triangles' vertices
};

/// Right-hand side for regions with weights of their own. h_(r,j) is the product of the vectors at
/// the vertices, times region r's share there, with displacement field j.
class RegionalRightHandSide {
 public:
  static constexpr int kLanes = VertexPull::kLanes;

  /// Parameters as for RightHandSide. `shares` (N x R) are of the target's vertices. Keeps a
  /// reference to the target's displacement fields.
  RegionalRightHandSide(const Positions& rest, const DeformationGradients& gradients,
                        const BlendshapeModel& target, const RegionShares& shares, EdgeSum sum);

  /// One row a frame (F x R D), with h_(r,j) in column r D + j. \pre as for RightHandSide
  Eigen::MatrixXd operator()(const Eigen::Ref<const Frames>& frames) const;

 private:
  /// A vertex of a region, its row among the sums, and the region's share.
  struct Held {
    VertexIndex vertex;
    int row;
    double share;
  };

  const Eigen::MatrixXd& fields_;
  VertexPull pull_;
  std::vector<std::vector<Held>> held_;  // one list per region
};

/// Data of eq. 10 for frames with an unknown head rotation R.
///
/// Let p_v be the sums that VertexPull gathers, x_0 the neutral around its centre and x_k the field
/// of expression k. The moments are M_k = sum_v p_v x_kv^T (3 x 3). Rotating all gradients by R^T
/// rotates p_v, so that A^T b and the best rotation follow from the M_k, without another pass over
/// the mesh.
class RotationMoments {
 public:
  static constexpr int kLanes = VertexPull::kLanes;
  /// [M_0 M_1 ... M_D], 3 x 3 (D + 1).
  using Moments = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  /// Parameters as for RightHandSide.
  RotationMoments(const Positions& rest, const DeformationGradients& gradients,
                  const BlendshapeModel& target, EdgeSum sum);

  /// Moments of each frame minus the moments of the rest pose. \pre as for RightHandSide
  std::vector<Moments> operator()(const Eigen::Ref<const Frames>& frames) const;
  /// Moments of the rest pose.
  const Moments& at_rest() const { return at_rest_; }

 private:
  VertexPull pull_;
  Eigen::MatrixXd fields_;  // x_0 x_1 ... at the selected triangles' vertices, three columns each
  Moments at_rest_;
};

}  // namespace mimetra
