#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Mean of the corners' weights of each triangle (M); `weights` of the vertices (N).
Eigen::VectorXd triangle_weights(const Triangles& triangles, const Eigen::VectorXd& weights);

/// The border of regions in the vertex solve where vertices take a share of the wanted motion.
///
/// With phi_i the mean of its corners' weights, triangle i wants the displacement gradient
/// phi_i (Q_i - I), and vertices of weight 0 stay. Where the weights change, that is no gradient of
/// any motion, and something must give: those triangles count less, by a factor that falls to
/// kSlack, and across their edges gradients want to differ as phi_i (Q_i - I) do, so that the
/// surface bends over the border's width and not at its ends; a border that is narrow for the
/// motion still creases. Where the weights are constant nothing is changed.
///
/// How much a triangle is of the border: b_i = min(1, |grad phi_i| diameter / 2), with the diameter
/// of the parts that have a weight. Smoothness is that of a plate which bends over the length
/// kBend l, whatever the size of triangles. l is the border's width: the mean of |grad phi| over
/// that of its square, at most diameter / 2.
class SoftBorder {
 public:
  /// `rest` N x 3, `triangles` M x 3, `weights` N in [0, 1]. Degenerate triangles are of no border.
  SoftBorder(const Positions& rest, const Triangles& triangles, const Eigen::VectorXd& weights);

  /// phi_i: the share of the wanted motion.
  double share(int triangle) const { return shares_[triangle]; }
  /// How much a triangle counts: kSlack^b, 1 where the weights are constant.
  double stiffness(int triangle) const;
  /// Of squared differences of the displacement gradients of two neighbours; 0 where neither is of
  /// the border.
  double smoothness(int triangle, int neighbor) const;
  /// How far all that is inside may be moved on (3) where `shift` would bring it to its place:
  /// about as far if that is little for the border, never by more than kMostShift of its width.
  Eigen::RowVector3d bearable(const Eigen::RowVector3d& shift) const;

  /// Measured on real faces: less lets the region's own gradients win, but bends the border more.
  static constexpr double kSlack = 0.03;
  static constexpr double kBend = 0.55;
  /// The border holds whole faces back by less than this, and lets them go; around one disc on a
  /// chin, which a jaw moves by half of its width, it would fold.
  static constexpr double kMostShift = 0.1;

 private:
  Eigen::VectorXd shares_;
  Eigen::VectorXd border_;  // b_i
  Eigen::VectorXd sizes_;   // of triangles, length
  Eigen::VectorXd counts_;  // target_share() of triangles
  double width_ = 0;        // l
};

}  // namespace mimetra
