#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "geodesic/sparse_factor.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/vertex_pull.h"

/// The system of gradient products that vertices are solved for by. Internal to those who solve it.
namespace mimetra {

/// A connected piece of triangles that holds no fixed vertex.
struct FloatingPiece {
  /// Ascending; of vertices that are one, the lowest.
  std::vector<VertexIndex> vertices;
  /// The first of `vertices` and all that are one with it.
  std::vector<VertexIndex> pin;
};

/// Which vertices are unknowns of the vertex solve.
struct VertexUnknowns {
  /// Unknown of each vertex (N), the same for those that are one; -1 where it is fixed or the pin
  /// of a floating piece.
  std::vector<int> of_vertex;
  int count = 0;
  std::vector<FloatingPiece> floating;
  /// The free vertices of each piece that fixed ones hold; ascending, of vertices that are one the
  /// lowest.
  std::vector<std::vector<VertexIndex>> held;
};

/// Numbers the vertices that are not `fixed` (N), less one pin per floating piece of the triangles
/// of positive weight (M). Triangles that share one vertex are one piece, also across a seam that
/// `weld` (N) closes. \pre vertices that are one are fixed together
VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed, const Weld& weld);

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds scale * X^T X at the unknowns of X's columns; -1 for none.
template <int Columns>
void add_products(const Eigen::Matrix<double, 3, Columns>& x, double scale,
                  const std::array<int, Columns>& unknowns, Triplets& entries) {
  const Eigen::Matrix<double, Columns, Columns> products = scale * x.transpose() * x;
  for (int a = 0; a < Columns; ++a) {
    for (int b = 0; b < Columns; ++b) {
      if (unknowns[a] < 0 || unknowns[b] < 0) continue;
      entries.emplace_back(unknowns[a], unknowns[b], products(a, b));
    }
  }
}

/// The factor of a system of `unknowns`, none for 0 of them. Throws std::runtime_error where the
/// triangles do not determine the vertices.
geodesic::SparseFactor factor_of(const Triplets& entries, int unknowns);

/// Two neighbours, and the weight of the squared difference of their displacement gradients.
struct SmoothEdge {
  int triangle, neighbor;
  double weight;
};

/// Adds what an edge asks to the system; `unknown_of_vertex` is -1 for none.
///
/// It acts on displacements and not on T_i - T_j, because there the fourth vertices of both
/// triangles would have to drop out together: without them even the rest pose would move.
void add_smoothness(const Positions& rest, const Triangles& triangles, const SmoothEdge& edge,
                    const std::vector<int>& unknown_of_vertex, Triplets& entries);

/// What the edges of a soft border ask of the right-hand side.
struct PullOverBorder {
  std::vector<Edges> own;  ///< of each selected triangle's own corners, as VertexPull takes them
  std::vector<VertexPull::Crossing> crossings;
};

/// Across the edges of a soft border gradients differ as the shares of the source's do, so that
/// smoothness costs nothing of the motion itself. Of mu ||G_i - G_j - (phi_i D_i - phi_j D_j)||^2
/// with D = Q - I in the planes of the target's triangles, vertex v has
///   mu (phi_i D_i - phi_j D_j) (g_iv - g_jv)
/// on the right-hand side.
PullOverBorder pull_over_border(const Positions& rest, const Triangles& triangles,
                                const SoftBorder& border, const std::vector<SmoothEdge>& edges,
                                const DeformationGradients& gradients);

}  // namespace mimetra
