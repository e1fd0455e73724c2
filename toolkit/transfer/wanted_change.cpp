#include "toolkit/transfer/wanted_change.h"

#include <algorithm>
#include <vector>

#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/product_blocking.h"
#include "toolkit/transfer/expression_edges.h"

namespace mimetra {

namespace {

constexpr int kTrianglesPerPiece = 256;

}  // namespace

Eigen::MatrixXd wanted_change(const DeformationGradients& gradients, const BlendshapeModel& target,
                              const FrameSource& performance, EdgeSum sum, const Context& context) {
  const std::vector<int>& selected = gradients.selected();
  const Eigen::Matrix2d factor = edge_factor(sum);
  Eigen::MatrixXd wanted(6 * selected.size(), performance.frames());
  const auto fill_frame = [&](int f) {
    const FrameBlock block(performance, f, 1);
    const auto q = gradients(block.frame(0));
    for (std::size_t s = 0; s < selected.size(); ++s) {
      const auto row = static_cast<Eigen::Index>(s);
      const Edges edges =
          edges_of(target.neutral(), target.triangles(), selected[s]).lazyProduct(factor);
      const Eigen::Matrix3d change = q.middleRows<3>(3 * row) - Eigen::Matrix3d::Identity();
      const Edges changed = change.lazyProduct(edges);
      wanted.col(f).segment<6>(6 * row) = changed.reshaped();
    }
  };
  parallel_for(performance.frames(), fill_frame, context);
  return wanted;
}

Eigen::MatrixXd unmet_change(Eigen::MatrixXd wanted, std::span<const int> triangles,
                             const BlendshapeModel& target, const Eigen::MatrixXd& weights,
                             EdgeSum sum, const Context& context) {
  fix_product_blocking();
  const auto count = static_cast<int>(triangles.size());
  const auto subtract = [&](int piece) {
    const int first = piece * kTrianglesPerPiece;
    const int size = std::min(kTrianglesPerPiece, count - first);
    wanted.middleRows(6 * first, 6 * size).noalias() -=
        edge_rows(target, triangles.subspan(first, size), sum) * weights.transpose();
  };
  parallel_for((count + kTrianglesPerPiece - 1) / kTrianglesPerPiece, subtract, context);
  return wanted;
}

}  // namespace mimetra
