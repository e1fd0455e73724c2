#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// How much more a surface bends at the border of regions than its source asks for.
///
/// The border are edges between triangles of which the weights phi differ. Edge ij bends by b, the
/// signed angle between the normals of its triangles less that at rest. The source asks for the
/// bend w, that of the normals which its gradients make of the rest's, det(Q) Q^-T n. The excess is
/// |b| less what of w goes the same way, at least 0. Edges count by their length at rest times
/// |phi_i - phi_j|, so that a border counts the same whether it is hard or fades.
class BorderCrease {
 public:
  /// `rest` N x 3, `triangles` M x 3 with vertices that are one written as one; `weights` M. Edges
  /// of triangles that do not count (M), or are degenerate at rest, and of more than two do not.
  BorderCrease(const Positions& rest, const Triangles& triangles, const Eigen::VectorXd& weights,
               const std::vector<bool>& counts);

  /// Of one frame, in degrees.
  struct Excess {
    double rms = 0;
    double largest = 0;
  };

  /// `wanted` are the edges that the source makes of those at rest (M), `pose` N x 3. Triangles
  /// that have no area there do not count. 0 without a border.
  Excess operator()(const std::vector<Edges>& wanted, const PositionsView& pose) const;

  bool empty() const { return hinges_.empty(); }

 private:
  struct Hinge {
    int first, second;  // triangles
    VertexIndex from, to;
    /// Of the edge, in the edges of each triangle.
    Eigen::Vector2d in_first, in_second;
    double weight;
    double at_rest;  // angle, radians
  };

  Triangles triangles_;
  std::vector<Hinge> hinges_;
};

}  // namespace mimetra
