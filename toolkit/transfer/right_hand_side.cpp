#include "toolkit/transfer/right_hand_side.h"

#include <algorithm>

#include "toolkit/mesh/progress.h"

namespace mimetra {

namespace {

/// V_i G of the selected triangles.
std::vector<Edges> neutral_edges(const BlendshapeModel& target, const std::vector<int>& selected,
                                 EdgeSum sum) {
  const Eigen::Matrix2d product = edge_product(sum);
  std::vector<Edges> edges;
  edges.reserve(selected.size());
  for (const int triangle : selected) {
    edges.push_back(edges_of(target.neutral(), target.triangles(), triangle).lazyProduct(product));
  }
  return edges;
}

/// Numbers the vertices of the selected triangles; -1 for the others.
std::vector<int> numbered_vertices(const BlendshapeModel& target,
                                   const std::vector<int>& selected) {
  std::vector<int> row(target.vertices(), -1);
  for (const int triangle : selected) {
    for (const VertexIndex vertex : target.triangles().row(triangle)) row[vertex] = 0;
  }
  int count = 0;
  for (int& number : row) {
    if (number == 0) number = count++;
  }
  return row;
}

/// Rows of the displacement fields at the selected triangles' vertices.
Eigen::MatrixXd rows_at(const Eigen::MatrixXd& basis, const std::vector<int>& row_of_vertex) {
  std::vector<Eigen::Index> rows;
  for (std::size_t v = 0; v < row_of_vertex.size(); ++v) {
    if (row_of_vertex[v] < 0) continue;
    for (int c = 0; c < 3; ++c) rows.push_back(static_cast<Eigen::Index>(3 * v + c));
  }
  return basis(rows, Eigen::all);
}

}  // namespace

RightHandSide::RightHandSide(const Positions& rest, const DeformationGradients& gradients,
                             const BlendshapeModel& target, EdgeSum sum)
    : pull_(rest, target.triangles(), gradients, neutral_edges(target, gradients.selected(), sum),
            numbered_vertices(target, gradients.selected())),
      basis_(rows_at(target.expressions().displacements,
                     numbered_vertices(target, gradients.selected()))) {}

Eigen::MatrixXd RightHandSide::operator()(const Eigen::Ref<const Frames>& frames) const {
  const VertexPull::Rows pull = pull_(frames);
  using Lanes = Eigen::Matrix<double, Eigen::Dynamic, kLanes, Eigen::RowMajor>;
  const Eigen::Map<const Lanes> sums(pull.data(), 3 * pull.rows(), kLanes);
  const Eigen::MatrixXd h = sums.transpose() * basis_;
  return h.topRows(frames.rows());
}

}  // namespace mimetra
