#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "geodesic/sparse_factor.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/vertex_pull.h"

/// Sparse system of gradient products whose unknowns are vertices. Internal to the classes that
/// solve it.
namespace mimetra {

/// Connected piece of triangles without a fixed vertex.
struct FloatingPiece {
  /// Lowest vertex of each point of the piece, ascending.
  std::vector<VertexIndex> vertices;
  /// First of `vertices`, and the vertices welded to it.
  std::vector<VertexIndex> pin;
};

struct VertexUnknowns {
  /// Unknown of each vertex (N), shared by welded vertices. -1 for fixed vertices and for the pin
  /// of a floating piece.
  std::vector<int> of_vertex;
  int count = 0;
  std::vector<FloatingPiece> floating;
  /// Free vertices of each piece that has a fixed vertex: the lowest of each point, ascending.
  std::vector<std::vector<VertexIndex>> held;
};

/// Numbers the vertices that are not `fixed` (N), except one pin per floating piece. Pieces consist
/// of triangles of positive weight (M). Triangles that share a vertex belong to one piece, also
/// across a seam that `weld` (N) closes. \pre welded vertices are fixed together
VertexUnknowns number_unknowns(const Triangles& triangles, const std::vector<double>& weights,
                               const std::vector<bool>& fixed, const Weld& weld);

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds scale * X^T X to the entries of the columns' unknowns. -1 marks a column without unknown.
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

/// Factor of a system of `unknowns`; empty if there are 0. Throws std::runtime_error if the
/// triangles do not determine the vertices.
geodesic::SparseFactor factor_of(const Triplets& entries, int unknowns);

/// Two neighbours, and the weight of the squared difference of their displacement gradients.
struct SmoothEdge {
  int triangle, neighbor;
  double weight;
};

/// Adds the products of one edge to the system. `unknown_of_vertex` is -1 for vertices without
/// unknown.
///
/// The term compares displacement gradients instead of T_i - T_j. For T_i - T_j, the fourth
/// vertices of both triangles would have to drop out together. Without them even the rest pose
/// would move.
void add_smoothness(const Positions& rest, const Triangles& triangles, const SmoothEdge& edge,
                    const std::vector<int>& unknown_of_vertex, Triplets& entries);

/// Contributions of a soft border's edges to the right-hand side.
struct PullOverBorder {
  std::vector<Edges> own;  ///< at each selected triangle's corners, as in VertexPull
  std::vector<VertexPull::Crossing> crossings;
};

/// Returns what the edges of a soft border add to the right-hand side. Across them gradients should
/// differ as the source's shares of motion do, so that smoothness does not resist the motion
/// itself. With D = Q - I in the planes of the target's triangles, an edge contributes
///   mu ||G_i - G_j - (phi_i D_i - phi_j D_j)||^2
/// to the energy and
///   mu (phi_i D_i - phi_j D_j) (g_iv - g_jv)
/// to the right-hand side at vertex v.
PullOverBorder pull_over_border(const Positions& rest, const Triangles& triangles,
                                const SoftBorder& border, const std::vector<SmoothEdge>& edges,
                                const DeformationGradients& gradients);

}  // namespace mimetra
