#pragma once

#include <functional>
#include <span>

#include "toolkit/model/blendshape_model.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// Rows of A in eq. 11: edges of the displacement fields of a target, six a triangle, so that A^T A
/// sums over edges as `sum` says (6 T x D for T triangles).
Eigen::MatrixXd edge_rows(const BlendshapeModel& target, std::span<const int> triangles,
                          EdgeSum sum);

/// Calls `work` with the edge_rows() of some of the triangles after the other: few enough that
/// those of every expression stay in cache.
void for_edge_rows(const BlendshapeModel& target, std::span<const int> triangles, EdgeSum sum,
                   const std::function<void(const Eigen::MatrixXd&)>& work);

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
