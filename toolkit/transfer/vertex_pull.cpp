#include "toolkit/transfer/vertex_pull.h"

#include <algorithm>
#include <array>

namespace mimetra {

namespace {

/// As many lanes as a register holds.
constexpr int kQuad = 4;
using Quad = Eigen::Array<double, 1, kQuad>;
using Vector = std::array<Quad, 3>;

/// Below any edge of a triangle. The normal of a triangle without area stays 0.
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

/// Vertices of a mesh that are used, numbered in the order of first use.
class Slots {
 public:
  Slots(const Triangles& triangles, std::size_t vertices)
      : triangles_(triangles), slot_of_vertex_(vertices, -1) {}

  /// Of a triangle's corners.
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

/// Sum of U~_i U_i^-1 x_iv, one row a slot of the target.
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

}  // namespace mimetra
