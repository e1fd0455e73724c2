#pragma once

#include <vector>

#include "geodesic/sparse_factor.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/transfer/vertex_unknowns.h"

namespace mimetra {

/// Displacement fields of a mesh and their gradients in the planes of its triangles, of which
/// vertices are found again. Internal to example_rig.
///
/// A gradient is 3 x 2, on an orthonormal basis of the triangle's plane: its norm and products are
/// those of the 3 x 3 gradient, whose third direction says nothing.
class PlaneGradients {
 public:
  using Gradient = Eigen::Matrix<double, 3, 2>;
  /// Six numbers a triangle, column by column of its gradient.
  static constexpr int kNumbers = 6;

  /// `rest` N x 3, `triangles` M x 3. Slivers and triangles that `weld` (N) collapses fade out.
  PlaneGradients(const Positions& rest, const Triangles& triangles, Weld weld);

  int triangles() const { return static_cast<int>(triangles_.rows()); }
  const Weld& weld() const { return weld_; }
  /// How much a triangle counts, 0 to 1.
  const std::vector<double>& counts() const { return counts_; }

  /// Gradients of fields (3N x D) at a triangle, 6 x D; 0 where it does not count.
  Eigen::MatrixXd at(int triangle, const Eigen::MatrixXd& fields) const;

  /// The field (3N) of the least squares of its gradients minus `gradients` (6M), 0 at `fixed`
  /// vertices (N); a piece without any has its pin at 0, which `unknowns` names. \pre vertices that
  /// are one are fixed together
  Eigen::VectorXd field_of(const Eigen::VectorXd& gradients, const VertexUnknowns& unknowns) const;

  /// Of vertices that are not fixed.
  VertexUnknowns unknowns(const std::vector<bool>& fixed) const;

 private:
  using Hats = Eigen::Matrix<double, 2, 3>;

  Triangles triangles_;
  Weld weld_;
  std::vector<double> counts_;
  std::vector<Hats> hats_;
};

}  // namespace mimetra
