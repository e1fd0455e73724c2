#include "toolkit/transfer/plane_gradients.h"

#include <array>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/gradient_system.h"

namespace mimetra {

PlaneGradients::PlaneGradients(const Positions& rest, const Triangles& triangles, Weld weld)
    : triangles_(triangles),
      weld_(std::move(weld)),
      counts_(triangles.rows(), 0),
      hats_(triangles.rows(), Hats::Zero()) {
  const Triangles welded = weld_.welded(triangles_);
  for (int t = 0; t < triangles_.rows(); ++t) {
    const auto corners = welded.row(t);
    const bool collapses =
        corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    const double count = collapses ? 0 : target_share(quality_of(rest, triangles_, t));
    if (count == 0) continue;
    counts_[t] = count;
    const Eigen::Matrix3d frame = triangle_frame(rest, triangles_, t);
    Gradient basis;
    basis.col(0) = frame.col(0).normalized();
    basis.col(1) = frame.col(2).cross(frame.col(0)).normalized();
    hats_[t] = basis.transpose() * hat_gradients(rest, triangles_, t);
  }
}

Eigen::MatrixXd PlaneGradients::at(int triangle, const Eigen::MatrixXd& fields) const {
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(kNumbers, fields.cols());
  for (int corner = 0; corner < 3; ++corner) {
    const auto here = fields.middleRows<3>(3 * Eigen::Index{triangles_(triangle, corner)});
    gradients.topRows<3>() += hats_[triangle](0, corner) * here;
    gradients.bottomRows<3>() += hats_[triangle](1, corner) * here;
  }
  return gradients;
}

VertexUnknowns PlaneGradients::unknowns(const std::vector<bool>& fixed) const {
  return number_unknowns(triangles_, counts_, fixed, weld_);
}

/// Normal equations sum_w (sum_i c_i h_iv . h_iw) d_w = sum_i c_i F_i h_iv.
Eigen::VectorXd PlaneGradients::field_of(const Eigen::VectorXd& gradients,
                                         const VertexUnknowns& unknowns) const {
  using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Triplets entries;
  Unknowns pull = Unknowns::Zero(unknowns.count, 3);
  for (int t = 0; t < triangles(); ++t) {
    if (counts_[t] == 0) continue;
    std::array<int, 3> of_corner;
    for (int c = 0; c < 3; ++c) of_corner[c] = unknowns.of_vertex[triangles_(t, c)];
    Eigen::Matrix3d hats = Eigen::Matrix3d::Zero();
    hats.topRows<2>() = hats_[t];
    add_products<3>(hats, counts_[t], of_corner, entries);
    const Eigen::Map<const Gradient> gradient(gradients.data() + Eigen::Index{kNumbers} * t);
    for (int c = 0; c < 3; ++c) {
      if (of_corner[c] < 0) continue;
      pull.row(of_corner[c]) += counts_[t] * (gradient * hats_[t].col(c)).transpose();
    }
  }
  const geodesic::SparseFactor factor = factor_of(entries, unknowns.count);
  Unknowns ordered(unknowns.count, 3);
  for (int u = 0; u < unknowns.count; ++u) ordered.row(factor.order()[u]) = pull.row(u);
  if (unknowns.count > 0) ordered = factor.solve<3>(std::move(ordered));
  const auto vertices = static_cast<Eigen::Index>(unknowns.of_vertex.size());
  Eigen::VectorXd field = Eigen::VectorXd::Zero(3 * vertices);
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const int unknown = unknowns.of_vertex[v];
    if (unknown >= 0) field.segment<3>(3 * v) = ordered.row(factor.order()[unknown]).transpose();
  }
  return field;
}

}  // namespace mimetra
