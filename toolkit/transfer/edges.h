#pragma once

#include <functional>
#include <numbers>
#include <span>
#include <string_view>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Edges [b - a, c - a] of a triangle a b c: the V of eq. 10.
using Edges = Eigen::Matrix<double, 3, 2>;

inline Edges edges_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                      int triangle) {
  const auto corners = triangles.row(triangle);
  Edges edges;
  edges.col(0) = (positions.row(corners[1]) - positions.row(corners[0])).transpose();
  edges.col(1) = (positions.row(corners[2]) - positions.row(corners[0])).transpose();
  return edges;
}

/// Over which edges of a triangle eq. 10 and 12 sum squares.
enum class EdgeSum {
  all,  ///< all three, times 2/3: the mean over the corners that a triangle can be written from
  two   ///< b - a and c - a: the paper's, which depends on the corner that is written first
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

/// The 2 x 2 matrix G by which the sum of squares of a change D of the edges is tr(D G D^T).
inline Eigen::Matrix2d edge_product(EdgeSum sum) {
  switch (sum) {
    case EdgeSum::all:
      return Eigen::Matrix2d{{4.0 / 3, -2.0 / 3}, {-2.0 / 3, 4.0 / 3}};
    case EdgeSum::two:
      break;
  }
  return Eigen::Matrix2d::Identity();
}

/// The lower triangular L of G = L L^T: squares of D L add up to the sum.
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

/// Rows of A in eq. 11: edges of the displacement fields of a target, six a triangle, so that A^T A
/// sums over edges as `sum` says (6 T x D for T triangles).
Eigen::MatrixXd edge_rows(const BlendshapeModel& target, std::span<const int> triangles,
                          EdgeSum sum);

/// A^T A of eq. 11 (D x D). Where `weights` are given, the square of triangle i counts weights[i]
/// times (M).
Eigen::MatrixXd gram_matrix(const BlendshapeModel& target, std::span<const int> triangles,
                            EdgeSum sum, const Eigen::VectorXd& weights = {});

/// Its diagonal (D): how much each expression moves on the triangles.
Eigen::VectorXd gram_diagonal(const BlendshapeModel& target, std::span<const int> triangles,
                              EdgeSum sum);

/// True for an expression that moves on some triangles, where `part` of its gram_diagonal() of
/// `all` triangles is: what zeros in single precision files leave is no motion.
bool moves_there(double part, double all);

/// How much a field of displacements (3N) moves each of all triangles (M): the squares of its
/// edges.
Eigen::VectorXd motion_of_triangles(const BlendshapeModel& target,
                                    const Eigen::Ref<const Eigen::VectorXd>& field, EdgeSum sum);

}  // namespace mimetra
