#pragma once

#include <vector>

#include "toolkit/transfer/gradient_system.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/vertex_pull.h"

/// Displacement gradients that want to differ little across edges. Internal to the vertex solve.
namespace mimetra {

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
