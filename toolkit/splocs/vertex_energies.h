#pragma once

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

class Reduction;

/// Vertex (of N) where the entry of `energies` (N) is largest, each times its entry of `weights`
/// (N, or empty for ones), the lowest of those that tie (kNearTie); -1 where no product
/// is above zero.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights = {});

/// The same, where a rank has the `energies` and `weights` of its vertices only (n). The vertex is
/// one of the mesh, on all ranks.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights, const Reduction& reduction);

/// Squared length of each vertex's displacement in one component (3N): N.
Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component);

}  // namespace mimetra
