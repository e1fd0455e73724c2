#pragma once

#include <vector>

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

}  // namespace mimetra
