#include "toolkit/transfer/vertex_pull.h"

#include <algorithm>
#include <array>

namespace mimetra {

namespace {

/// Number of lanes in a register.
constexpr int kQuad = 4;
using Quad = Eigen::Array<double, 1, kQuad>;
using Vector = std::array<Quad, 3>;

/// Below any edge length, so that the normal of a triangle without area stays 0.
constexpr double kNoLength = 1e-80;

Vector read(const double* row) {
  const auto axis = [row](int c) { return Eigen::Map<const Quad>(row + c * VertexPull::kLanes); };
  return {axis(0), axis(1), axis(2)};
}

void add(const Vector& vector, double* row) {
  for (int c = 0; c < 3; ++c) Eigen::Map<Quad>(row + c * VertexPull::kLanes) += vector[c];
}

Vector difference(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// n / sqrt|n| of the normal n = e1 x e2.
Vector scaled_normal(const Vector& e1, const Vector& e2) {
  const Quad x = e1[1] * e2[2] - e1[2] * e2[1];
  const Quad y = e1[2] * e2[0] - e1[0] * e2[2];
  const Quad z = e1[0] * e2[1] - e1[1] * e2[0];
  const Quad root = (x * x + y * y + z * z).sqrt().sqrt();
  const Quad scale = root.max(kNoLength).inverse();
  return {x * scale, y * scale, z * scale};
}

/// Vertices that a mesh's terms use, numbered in the order of first use.
class Slots {
 public:
  Slots(const Triangles& triangles, std::size_t vertices)
      : triangles_(triangles), slot_of_vertex_(vertices, -1) {}

  /// Slots of a triangle's corners.
  Eigen::Vector3i operator()(int triangle) {
    Eigen::Vector3i slots;
    for (int c = 0; c < 3; ++c) slots[c] = slot_of(triangles_(triangle, c));
    return slots;
  }
  const std::vector<VertexIndex>& vertices() const { return vertices_; }

 private:
  int slot_of(VertexIndex vertex) {
    int& slot = slot_of_vertex_[vertex];
    if (slot < 0) {
      slot = static_cast<int>(vertices_.size());
      vertices_.push_back(vertex);
    }
    return slot;
  }

  const Triangles& triangles_;
  std::vector<VertexIndex> vertices_;
  std::vector<int> slot_of_vertex_;
};

}  // namespace

VertexPull::VertexPull(const Positions& rest, const Triangles& source, const Triangles& target,
                       const DeformationGradients& gradients, const std::vector<Edges>& vectors,
                       const std::vector<int>& row_of_vertex,
                       const std::vector<Crossing>& crossings) {
  if (!row_of_vertex.empty()) rows_ = std::ranges::max(row_of_vertex) + 1;
  Slots from(source, rest.rows()), to(target, row_of_vertex.size());
  const auto add_terms = [&](const Crossing& crossing) {
    if (crossing.vectors.isZero(0)) return;
    for (const auto& [triangle, share] : gradients.parts(crossing.selected)) {
      terms_.push_back({from(triangle), to(crossing.triangle),
                        share * gradients.inverse_frame(triangle) * crossing.vectors});
    }
  };
  for (std::size_t s = 0; s < vectors.size(); ++s) {
    add_terms({static_cast<int>(s), gradients.selected()[s], vectors[s]});
  }
  for (const Crossing& crossing : crossings) add_terms(crossing);
  vertices_ = from.vertices();
  for (const VertexIndex vertex : to.vertices()) row_of_slot_.push_back(row_of_vertex[vertex]);
  const Rows at_rest = sums(gather(Eigen::Map<const Frames>(rest.data(), 1, rest.size())));
  at_rest_.resize(at_rest.rows(), 3);
  for (Eigen::Index slot = 0; slot < at_rest.rows(); ++slot) {
    for (int c = 0; c < 3; ++c) at_rest_(slot, c) = at_rest(slot, c * kLanes);
  }
}

/// Positions of the used vertices, one frame a lane.
VertexPull::Rows VertexPull::gather(const Eigen::Ref<const Frames>& frames) const {
  std::array<const double*, kLanes> frame;
  for (int lane = 0; lane < kLanes; ++lane) {
    frame[lane] = frames.row(std::min<Eigen::Index>(lane, frames.rows() - 1)).data();
  }
  Rows positions(vertices_.size(), kWidth);
  double* to = positions.data();
  for (const VertexIndex vertex : vertices_) {
    for (int c = 0; c < 3; ++c) {
      for (int lane = 0; lane < kLanes; ++lane) *to++ = frame[lane][3 * vertex + c];
    }
  }
  return positions;
}

/// Sums of U~_i U_i^-1 x_iv, one row a slot of the target.
VertexPull::Rows VertexPull::sums(const Rows& positions) const {
  Rows result = Rows::Zero(static_cast<Eigen::Index>(row_of_slot_.size()), kWidth);
  for (const Term& term : terms_) {
    const auto from = [&](int corner) { return positions.row(term.source[corner]).data(); };
    const auto to = [&](int corner) { return result.row(term.target[corner]).data(); };
    for (int lane = 0; lane < kLanes; lane += kQuad) {
      const Vector a = read(from(0) + lane);
      const Vector e1 = difference(read(from(1) + lane), a);
      const Vector e2 = difference(read(from(2) + lane), a);
      const Vector n = scaled_normal(e1, e2);
      Vector at_a, at_b, at_c;
      for (int c = 0; c < 3; ++c) {
        at_b[c] = term.factor(0, 0) * e1[c] + term.factor(1, 0) * e2[c] + term.factor(2, 0) * n[c];
        at_c[c] = term.factor(0, 1) * e1[c] + term.factor(1, 1) * e2[c] + term.factor(2, 1) * n[c];
        at_a[c] = -at_b[c] - at_c[c];
      }
      add(at_a, to(0) + lane);
      add(at_b, to(1) + lane);
      add(at_c, to(2) + lane);
    }
  }
  return result;
}

VertexPull::Rows VertexPull::operator()(const Eigen::Ref<const Frames>& frames) const {
  const Rows all = sums(gather(frames));
  Rows result = Rows::Zero(rows_, kWidth);
  for (std::size_t slot = 0; slot < row_of_slot_.size(); ++slot) {
    const int row = row_of_slot_[slot];
    if (row < 0) continue;
    for (int c = 0; c < 3; ++c) {
      result.row(row).segment<kLanes>(c * kLanes).array() +=
          all.row(slot).segment<kLanes>(c * kLanes).array() - at_rest_(slot, c);
    }
  }
  return result;
}

namespace {

/// V_i G of the selected triangles, times their `weights` (M) if there are any.
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

/// Numbers of the selected triangles' vertices; -1 for the others.
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

/// Neutral around its centre and displacement fields at the numbered vertices, three columns each.
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

/// Sums of V_i G at the vertices: the pull of identity gradients.
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
