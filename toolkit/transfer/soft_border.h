#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Mean weight of each triangle's corners (M), from the `weights` of the vertices (N).
Eigen::VectorXd triangle_weights(const Triangles& triangles, const Eigen::VectorXd& weights);

/// Soft border of regions in the vertex solve, for vertices that take a share of the wanted motion.
///
/// phi_i is the mean of the corners' weights. The wanted displacement gradient of triangle i is
/// phi_i (Q_i - I), and vertices of weight 0 stay. If the weights change, no motion has exactly
/// these gradients. Two changes let the surface bend over the border's width and not at its ends.
/// Triangles of the border count less, by a factor that falls to kSlack. Across their edges,
/// gradients should differ as phi_i (Q_i - I) do. A border that is narrow for the motion still
/// creases. Nothing changes where the weights are constant.
///
/// b_i = min(1, |grad phi_i| diameter / 2) says how much triangle i belongs to the border. The
/// diameter is taken over the parts that have a weight. Smoothness acts as a plate that bends over
/// the length kBend l, whatever the size of triangles. l is the border's width: the mean of |grad
/// phi| over the mean of |grad phi|^2, at most diameter / 2.
class SoftBorder {
 public:
  /// `rest` N x 3, `triangles` M x 3, `weights` N in [0, 1]. Degenerate triangles belong to no
  /// border.
  SoftBorder(const Positions& rest, const Triangles& triangles, const Eigen::VectorXd& weights);

  /// phi_i: share of the wanted motion.
  double share(int triangle) const { return shares_[triangle]; }
  /// Weight of a triangle: kSlack^b, and 1 where the weights are constant.
  double stiffness(int triangle) const;
  /// Weight of the squared difference of two neighbours' displacement gradients. 0 if neither
  /// belongs to the border or one is degenerate.
  double smoothness(int triangle, int neighbor) const;
  /// Translation that the border can bear (3), for a `shift` that would bring all vertices inside
  /// to their place. It is close to `shift` if that is small, and never longer than kMostShift of
  /// the border's width.
  Eigen::RowVector3d bearable(const Eigen::RowVector3d& shift) const;

  /// Measured on real faces. A smaller kSlack follows the region's own gradients more closely, but
  /// bends the border more.
  static constexpr double kSlack = 0.03;
  static constexpr double kBend = 0.55;
  /// Largest translation as a share of the border's width. The border holds whole faces back by
  /// less than this, and then lets them go. A single disc on a chin, which a jaw moves by half of
  /// the disc's width, would fold.
  static constexpr double kMostShift = 0.1;

 private:
  Eigen::VectorXd shares_;
  Eigen::VectorXd border_;  // b_i
  Eigen::VectorXd sizes_;   // size of each triangle, a length
  Eigen::VectorXd counts_;  // target_share() of each triangle
  double width_ = 0;        // l
};

}  // namespace mimetra
