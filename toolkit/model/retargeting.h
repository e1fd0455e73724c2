#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// Map from weights w of one rig to weights beta of another without their meshes: minimise beta^T G
/// beta / 2 - (H w)^T beta over lower <= beta <= upper. It is the transfer between their meshes
/// (eq. 10, 11), with the right-hand side linearised at the source's neutral.
struct Retargeting {
  std::vector<std::string> source_names;  ///< D_s
  std::vector<std::string> target_names;  ///< D_t
  Eigen::MatrixXd gram;                   ///< G, D_t x D_t
  Eigen::MatrixXd linear;                 ///< H, D_t x D_s
  Eigen::VectorXd lower, upper;  ///< D_t; equal if no triangle of the map shows the expression

  /// Expressions of the target that can move, ascending.
  std::vector<Eigen::Index> free() const;
  /// Throws std::invalid_argument for missing or repeated names, sizes that disagree, numbers that
  /// are not finite and bounds that cross. Throws it also if G is not symmetric or has a negative
  /// eigenvalue.
  void check() const;
};

/// M = G^+ H (D_t x D_s): the shortest beta that solves the problem without bounds is M w. Rows of
/// expressions that cannot move are 0. Programs that multiply weights by a matrix use this one.
Eigen::MatrixXd plain_matrix(const Retargeting& map);

/// M w of every frame (F x D_t) for the source's weights w (F x D_s).
Eigen::MatrixXd multiplied(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& weights);

/// Clamps weights (F x D_t) to the bounds.
Eigen::MatrixXd clipped(const Eigen::MatrixXd& weights, const Retargeting& map);

/// Difference between two sets of weights, over all frames and expressions.
struct WeightDifference {
  double rms = 0;
  double mean = 0;  ///< mean of absolute differences
  double largest = 0;
};

/// Returns 0 for no weights. Throws std::invalid_argument if the sizes differ.
WeightDifference difference_of(const Eigen::MatrixXd& weights, const Eigen::MatrixXd& others);

}  // namespace mimetra
