#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// What takes weights w of one rig to weights beta of another without their meshes: minimise
/// beta^T G beta / 2 - (H w)^T beta over lower <= beta <= upper. It is the transfer between their
/// meshes (eq. 10, 11) with its right-hand side linearised at the source's neutral.
struct Retargeting {
  std::vector<std::string> source_names;  ///< D_s
  std::vector<std::string> target_names;  ///< D_t
  Eigen::MatrixXd gram;                   ///< G, D_t x D_t
  Eigen::MatrixXd linear;                 ///< H, D_t x D_s
  Eigen::VectorXd lower, upper;           ///< D_t; equal where nothing shows an expression

  /// Expressions of the target that can move, ascending.
  std::vector<Eigen::Index> free() const;
  /// Throws std::invalid_argument for no names or one twice, for sizes that disagree, numbers that
  /// are not finite, bounds that cross, and a G that is not symmetric or has a negative eigenvalue.
  void check() const;
};

/// M = G^+ H (D_t x D_s), the least beta that solves it without bounds; rows of 0 where nothing can
/// move. What programs take that multiply weights by a matrix.
Eigen::MatrixXd plain_matrix(const Retargeting& map);

/// M w of every frame (F x D_t) of the source's weights w (F x D_s).
Eigen::MatrixXd multiplied(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& weights);

/// Weights (F x D_t) within the bounds.
Eigen::MatrixXd clipped(const Eigen::MatrixXd& weights, const Retargeting& map);

/// How far weights are from others, over all frames and expressions.
struct WeightDifference {
  double rms = 0;
  double mean = 0;  ///< of absolute values
  double largest = 0;
};

/// Throws std::invalid_argument where sizes differ; 0 for no weights.
WeightDifference difference_of(const Eigen::MatrixXd& weights, const Eigen::MatrixXd& others);

}  // namespace mimetra
