#include <mimetra/transfer/folded_right_hand_side.h>

#include <algorithm>

#include <mimetra/transfer/edges.h>

namespace mimetra {

namespace {

/// Normals of so many triangles are formed before they are multiplied: they stay in the first
/// cache.
constexpr int kTrianglesPerBlock = 128;

}  // namespace

FoldedRightHandSide::FoldedRightHandSide(const Positions& rest, const Triangles& triangles,
                                         const DeformationGradients& gradients,
                                         const BlendshapeModel& target)
    : vertex_slot_(rest.rows(), -1), triangle_slot_(triangles.rows(), -1) {
  number(triangles, gradients);
  fold(triangles, gradients, target);
  const Eigen::Map<const Frames> frame(rest.data(), 1, rest.size());
  const Lanes positions = gather(frame, 0);
  rest_ = positions.col(0);
  const auto count = static_cast<int>(corners_.rows());
  Lanes at_rest(3 * count, kLanes);
  normals(positions, 0, count, at_rest);
  rest_normals_ = at_rest.col(0);
}

/// Numbers the triangles whose gradients are used, and their vertices, in the order of first use.
void FoldedRightHandSide::number(const Triangles& triangles,
                                 const DeformationGradients& gradients) {
  std::vector<int> used;
  for (std::size_t s = 0; s < gradients.selected().size(); ++s) {
    for (const int source : gradients.sources(static_cast<int>(s))) {
      if (triangle_slot_[source] >= 0) continue;
      triangle_slot_[source] = static_cast<int>(used.size());
      used.push_back(source);
    }
  }
  corners_.resize(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t i = 0; i < used.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex vertex = triangles(used[i], c);
      if (vertex_slot_[vertex] < 0) {
        vertex_slot_[vertex] = static_cast<int>(vertices_.size());
        vertices_.push_back(vertex);
      }
      corners_(static_cast<Eigen::Index>(i), c) = vertex_slot_[vertex];
    }
  }
}

void FoldedRightHandSide::fold(const Triangles& triangles, const DeformationGradients& gradients,
                               const BlendshapeModel& target) {
  const Eigen::MatrixXd& basis = target.expressions().displacements;
  const Eigen::Index d = basis.cols();
  on_positions_ = Eigen::MatrixXd::Zero(d, 3 * static_cast<Eigen::Index>(vertices_.size()));
  on_normals_ = Eigen::MatrixXd::Zero(d, 3 * corners_.rows());
  // Rows are expressions; three columns a column of M_ij.
  Eigen::Matrix<double, Eigen::Dynamic, 3> first(d, 3), second(d, 3);
  for (std::size_t s = 0; s < gradients.selected().size(); ++s) {
    const int triangle = gradients.selected()[s];
    const auto corners = triangles.row(triangle);
    const auto at = [&basis](VertexIndex v) { return basis.middleRows<3>(3 * v).transpose(); };
    first = at(corners[1]) - at(corners[0]);
    second = at(corners[2]) - at(corners[0]);
    const auto& sources = gradients.sources(static_cast<int>(s));
    const Edges edges = edges_of(target.neutral(), triangles, triangle);
    for (const int source : sources) {
      const Eigen::Matrix<double, 3, 2> factor =
          gradients.inverse_frame(source) * edges / static_cast<double>(sources.size());
      const int slot = triangle_slot_[source];
      const auto column = [&](int c) { return factor(c, 0) * first + factor(c, 1) * second; };
      for (const int c : {0, 1}) {
        on_positions_.middleCols<3>(3 * corners_(slot, 0)) -= column(c);
        on_positions_.middleCols<3>(3 * corners_(slot, c + 1)) += column(c);
      }
      on_normals_.middleCols<3>(3 * slot) += column(2);
    }
  }
}

/// Positions of the used vertices in frames first, first + 1, ..., one frame a column; the last
/// frame again where there are fewer.
FoldedRightHandSide::Lanes FoldedRightHandSide::gather(const Eigen::Ref<const Frames>& frames,
                                                       int first) const {
  Lanes positions(3 * vertices_.size(), kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Index f = std::min<Eigen::Index>(first + lane, frames.rows() - 1);
    const double* frame = frames.row(f).data();
    double* to = positions.data() + lane;
    for (const VertexIndex vertex : vertices_) {
      for (int c = 0; c < 3; ++c, to += kLanes) *to = frame[3 * vertex + c];
    }
  }
  return positions;
}

/// n / sqrt|n| of triangles first, ..., first + count - 1.
void FoldedRightHandSide::normals(const Lanes& positions, int first, int count,
                                  Lanes& result) const {
  for (int i = 0; i < count; ++i) {
    const auto corners = corners_.row(first + i);
    Lane edge[2][3];
    for (int c = 0; c < 3; ++c) {
      const Lane origin = positions.row(3 * corners[0] + c);
      edge[0][c] = positions.row(3 * corners[1] + c).array() - origin;
      edge[1][c] = positions.row(3 * corners[2] + c).array() - origin;
    }
    Lane normal[3], squared = Lane::Zero();
    for (int c = 0; c < 3; ++c) {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      normal[c] = edge[0][a] * edge[1][b] - edge[0][b] * edge[1][a];
      squared += normal[c].square();
    }
    const Lane root = squared.sqrt().sqrt();
    const Lane scale = (root > 0).select(root.inverse(), 0.0);
    for (int c = 0; c < 3; ++c) result.row(3 * i + c) = normal[c] * scale;
  }
}

Eigen::MatrixXd FoldedRightHandSide::operator()(const Eigen::Ref<const Frames>& frames) const {
  Eigen::MatrixXd result(frames.rows(), on_positions_.rows());
  Lanes changes(3 * kTrianglesPerBlock, kLanes);
  Eigen::Matrix<double, Eigen::Dynamic, kLanes> h(on_positions_.rows(), kLanes);
  for (int first = 0; first < frames.rows(); first += kLanes) {
    Lanes positions = gather(frames, first);
    h.setZero();
    for (int start = 0; start < corners_.rows(); start += kTrianglesPerBlock) {
      const int count = std::min(kTrianglesPerBlock, static_cast<int>(corners_.rows()) - start);
      normals(positions, start, count, changes);
      changes.topRows(3 * count).colwise() -= rest_normals_.segment(3 * start, 3 * count);
      h.noalias() += on_normals_.middleCols(3 * start, 3 * count) * changes.topRows(3 * count);
    }
    positions.colwise() -= rest_;
    h.noalias() += on_positions_ * positions;
    const Eigen::Index lanes = std::min<Eigen::Index>(kLanes, frames.rows() - first);
    result.middleRows(first, lanes) = h.leftCols(lanes).transpose();
  }
  return result;
}

}  // namespace mimetra
