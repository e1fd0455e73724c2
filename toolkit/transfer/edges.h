#pragma once

#include <functional>
#include <numbers>
#include <span>
#include <string_view>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Edges [b - a, c - a] of a triangle a b c: the matrix V of eq. 10.
using Edges = Eigen::Matrix<double, 3, 2>;

inline Edges edges_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                      int triangle) {
  const auto corners = triangles.row(triangle);
  Edges edges;
  edges.col(0) = (positions.row(corners[1]) - positions.row(corners[0])).transpose();
  edges.col(1) = (positions.row(corners[2]) - positions.row(corners[0])).transpose();
  return edges;
}

/// Edges of a triangle over which eq. 10 and 12 sum squares.
enum class EdgeSum {
  all,  ///< all three, times 2/3: the mean over the three choices of the first corner
  two   ///< b - a and c - a, as in the paper: the sum depends on the first corner
};

constexpr std::string_view choice_name(EdgeSum value) {
  switch (value) {
    case EdgeSum::all:
      return "all";
    case EdgeSum::two:
      return "two";
  }
  return {};
}

/// Matrix G (2 x 2) for which tr(D G D^T) is the sum of squares of a change D of the edges.
inline Eigen::Matrix2d edge_product(EdgeSum sum) {
  switch (sum) {
    case EdgeSum::all:
      return Eigen::Matrix2d{{4.0 / 3, -2.0 / 3}, {-2.0 / 3, 4.0 / 3}};
    case EdgeSum::two:
      break;
  }
  return Eigen::Matrix2d::Identity();
}

/// Lower triangular matrix L with G = L L^T: the sum is the squared Frobenius norm of D L.
inline Eigen::Matrix2d edge_factor(EdgeSum sum) {
  constexpr double kRoot3 = std::numbers::sqrt3;
  switch (sum) {
    case EdgeSum::all:
      return Eigen::Matrix2d{{2 / kRoot3, 0}, {-1 / kRoot3, 1}};
    case EdgeSum::two:
      break;
  }
  return Eigen::Matrix2d::Identity();
}

/// Matrix A of eq. 11 (6 T x D for T triangles): the edges of the target's displacement fields, six
/// rows a triangle. They are scaled so that A^T A sums over edges as `sum` says.
Eigen::MatrixXd edge_rows(const BlendshapeModel& target, std::span<const int> triangles,
                          EdgeSum sum);

/// A^T A of eq. 11 (D x D). If `weights` (M) are given, the square of triangle i is multiplied by
/// weights[i].
Eigen::MatrixXd gram_matrix(const BlendshapeModel& target, std::span<const int> triangles,
                            EdgeSum sum, const Eigen::VectorXd& weights = {});

/// Diagonal of gram_matrix() without weights (D): how much each expression moves the triangles.
Eigen::VectorXd gram_diagonal(const BlendshapeModel& target, std::span<const int> triangles,
                              EdgeSum sum);

/// Returns true if an expression moves some triangles. `part` is its gram_diagonal() over these,
/// `all` over all triangles. Rounding to single precision is not motion.
bool moves_there(double part, double all);

/// Squared edge changes of each triangle (M) under a field of displacements (3N).
Eigen::VectorXd motion_of_triangles(const BlendshapeModel& target,
                                    const Eigen::Ref<const Eigen::VectorXd>& field, EdgeSum sum);

}  // namespace mimetra
