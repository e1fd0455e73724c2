#include "toolkit/transfer/soft_border.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "toolkit/mesh/surface_parts.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

namespace {

/// Slope of the weights over the diameter from which a triangle belongs fully to the border. A fade
/// over half the diameter has this slope. The steps that rounding to 8 bits leaves of a constant
/// are hardly a border.
constexpr double kBorderSlope = 2;

}  // namespace

Eigen::VectorXd triangle_weights(const Triangles& triangles, const Eigen::VectorXd& weights) {
  Eigen::VectorXd means(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    // Exact if all three weights are equal.
    const double a = weights[triangles(t, 0)];
    means[t] = a + ((weights[triangles(t, 1)] - a) + (weights[triangles(t, 2)] - a)) / 3;
  }
  return means;
}

SoftBorder::SoftBorder(const Positions& rest, const Triangles& triangles,
                       const Eigen::VectorXd& weights)
    : shares_(triangle_weights(triangles, weights)),
      border_(Eigen::VectorXd::Zero(triangles.rows())),
      sizes_(Eigen::VectorXd::Zero(triangles.rows())),
      counts_(Eigen::VectorXd::Zero(triangles.rows())) {
  std::vector<VertexIndex> moving;
  for (VertexIndex v = 0; v < weights.size(); ++v) {
    if (weights[v] > 0) moving.push_back(v);
  }
  const double steepest = kBorderSlope / diameter_of_parts(rest, triangles, moving);
  double slopes = 0, squares = 0;
  for (int t = 0; t < triangles.rows(); ++t) {
    counts_[t] = target_share(quality_of(rest, triangles, t));
    if (counts_[t] == 0) continue;
    const Edges edges = edges_of(rest, triangles, t);
    const double twice_area = edges.col(0).cross(edges.col(1)).norm();
    sizes_[t] = std::sqrt(twice_area);
    const double a = weights[triangles(t, 0)];
    const Eigen::Vector2d differences(weights[triangles(t, 1)] - a, weights[triangles(t, 2)] - a);
    const Eigen::Vector3d gradient = hat_gradients(rest, triangles, t).rightCols<2>() * differences;
    const double slope = gradient.norm();
    border_[t] = std::min(1.0, slope / steepest);
    slopes += counts_[t] * twice_area * slope;
    squares += counts_[t] * twice_area * slope * slope;
  }
  // The width is bounded, because a wider border would smooth a whole surface whose weights are
  // rounded.
  if (squares > 0) width_ = std::min(slopes / squares, 1 / steepest);
}

double SoftBorder::stiffness(int triangle) const {
  return std::pow(kSlack, border_[triangle]);
}

Eigen::RowVector3d SoftBorder::bearable(const Eigen::RowVector3d& shift) const {
  if (width_ == 0) return Eigen::RowVector3d::Zero();
  return shift / std::hypot(1, shift.norm() / (kMostShift * width_));
}

double SoftBorder::smoothness(int triangle, int neighbor) const {
  const double counts = std::min(counts_[triangle], counts_[neighbor]);
  if (counts == 0) return 0;
  const double bend = kBend * width_;
  return counts * std::max(border_[triangle], border_[neighbor]) * kSlack * bend * bend /
         (sizes_[triangle] * sizes_[neighbor]);
}

}  // namespace mimetra
