#include "toolkit/transfer/right_hand_side.h"

#include <algorithm>

namespace mimetra {

namespace {

/// V_i G of the selected triangles, times their weights (M) where they have some.
std::vector<Edges> neutral_edges(const BlendshapeModel& target, const std::vector<int>& selected,
                                 EdgeSum sum, const Eigen::VectorXd& weights = {}) {
  const Eigen::Matrix2d product = edge_product(sum);
  std::vector<Edges> edges;
  edges.reserve(selected.size());
  for (const int triangle : selected) {
    edges.push_back(edges_of(target.neutral(), target.triangles(), triangle).lazyProduct(product));
    if (weights.size() > 0) edges.back() *= weights[triangle];
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

/// The neutral from its centre and the displacement fields at those vertices, three columns each.
Eigen::MatrixXd fields_at(const BlendshapeModel& target, const std::vector<int>& row_of_vertex) {
  const Eigen::MatrixXd rows = rows_at(target.expressions().displacements, row_of_vertex);
  const Eigen::Index vertices = rows.rows() / 3;
  Eigen::MatrixXd fields(vertices, 3 * (rows.cols() + 1));
  for (std::size_t v = 0; v < row_of_vertex.size(); ++v) {
    if (row_of_vertex[v] < 0) continue;
    fields.row(row_of_vertex[v]).head<3>() = target.neutral().row(static_cast<Eigen::Index>(v));
  }
  const Eigen::RowVector3d center = fields.leftCols<3>().colwise().mean();
  fields.leftCols<3>().rowwise() -= center;
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    fields.middleCols<3>(3 * (j + 1)) =
        Eigen::Map<const Positions>(rows.col(j).data(), vertices, 3);
  }
  return fields;
}

/// The sums of V_i G themselves: what identities pull.
Positions pull_at_rest(const BlendshapeModel& target, const std::vector<int>& selected,
                       const std::vector<Edges>& vectors, const std::vector<int>& row_of_vertex) {
  Positions pull = Positions::Zero(std::ranges::max(row_of_vertex) + 1, 3);
  for (std::size_t s = 0; s < selected.size(); ++s) {
    const auto corners = target.triangles().row(selected[s]);
    pull.row(row_of_vertex[corners[0]]) -= vectors[s].rowwise().sum().transpose();
    pull.row(row_of_vertex[corners[1]]) += vectors[s].col(0).transpose();
    pull.row(row_of_vertex[corners[2]]) += vectors[s].col(1).transpose();
  }
  return pull;
}

}  // namespace

RightHandSide::RightHandSide(const Positions& rest, const DeformationGradients& gradients,
                             const BlendshapeModel& target, EdgeSum sum,
                             const Eigen::VectorXd& weights)
    : pull_(rest, gradients.triangles(), target.triangles(), gradients,
            neutral_edges(target, gradients.selected(), sum, weights),
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

RegionalRightHandSide::RegionalRightHandSide(const Positions& rest,
                                             const DeformationGradients& gradients,
                                             const BlendshapeModel& target,
                                             const RegionShares& shares, EdgeSum sum)
    : fields_(target.expressions().displacements),
      pull_(rest, gradients.triangles(), target.triangles(), gradients,
            neutral_edges(target, gradients.selected(), sum),
            numbered_vertices(target, gradients.selected())),
      held_(shares.cols()) {
  const std::vector<int> row_of_vertex = numbered_vertices(target, gradients.selected());
  for (Eigen::Index r = 0; r < shares.cols(); ++r) {
    for (RegionShares::InnerIterator share(shares, r); share; ++share) {
      const auto vertex = static_cast<VertexIndex>(share.index());
      if (row_of_vertex[vertex] < 0) continue;
      held_[r].push_back({vertex, row_of_vertex[vertex], share.value()});
    }
  }
}

Eigen::MatrixXd RegionalRightHandSide::operator()(const Eigen::Ref<const Frames>& frames) const {
  const VertexPull::Rows pull = pull_(frames);
  const Eigen::Index D = fields_.cols();
  Eigen::MatrixXd h(frames.rows(), D * static_cast<Eigen::Index>(held_.size()));
  for (std::size_t r = 0; r < held_.size(); ++r) {
    const std::vector<Held>& held = held_[r];
    const auto rows = static_cast<Eigen::Index>(3 * held.size());
    Eigen::MatrixXd sums(kLanes, rows), basis(rows, D);
    for (std::size_t i = 0; i < held.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      for (int c = 0; c < 3; ++c) {
        sums.col(at + c) =
            held[i].share *
            pull.row(held[i].row).segment<kLanes>(static_cast<Eigen::Index>(c) * kLanes);
      }
      basis.middleRows<3>(at) = fields_.middleRows<3>(3 * held[i].vertex);
    }
    const Eigen::MatrixXd of_region = sums * basis;
    h.middleCols(static_cast<Eigen::Index>(r) * D, D) = of_region.topRows(frames.rows());
  }
  return h;
}

RotationMoments::RotationMoments(const Positions& rest, const DeformationGradients& gradients,
                                 const BlendshapeModel& target, EdgeSum sum)
    : pull_(rest, gradients.triangles(), target.triangles(), gradients,
            neutral_edges(target, gradients.selected(), sum),
            numbered_vertices(target, gradients.selected())),
      fields_(fields_at(target, numbered_vertices(target, gradients.selected()))) {
  const std::vector<int>& selected = gradients.selected();
  at_rest_ = pull_at_rest(target, selected, neutral_edges(target, selected, sum),
                          numbered_vertices(target, selected))
                 .transpose() *
             fields_;
}

std::vector<RotationMoments::Moments> RotationMoments::operator()(
    const Eigen::Ref<const Frames>& frames) const {
  const VertexPull::Rows pull = pull_(frames);
  const Eigen::MatrixXd products = pull.transpose() * fields_;
  std::vector<Moments> moments(frames.rows(), Moments(3, fields_.cols()));
  for (Eigen::Index row = 0; row < frames.rows(); ++row) {
    for (int c = 0; c < 3; ++c) moments[row].row(c) = products.row(c * kLanes + row);
  }
  return moments;
}

}  // namespace mimetra
