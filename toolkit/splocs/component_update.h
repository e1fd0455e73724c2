#pragma once

#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

struct AdmmOptions {
  double sparsity;  ///< lambda
  double rho;
  int steps;
};

/// Components after an update, with all that the next weights and the energy need of them: P, H and
/// the penalty are sums over the mesh, which the first rank has and no other.
template <typename Scalar>
struct ComponentUpdate {
  VertexBlocks<Scalar> C;  ///< components, K x 3n
  VertexBlocks<Scalar> U;  ///< scaled dual variable of ADMM, K x 3n; it persists over the updates
  Eigen::MatrixXd P;       ///< X C^T, R x K
  Eigen::MatrixXd H;       ///< C C^T, K x K
  double penalty = 0;      ///< sum_k sum_i Lambda_ki |c_k^(i)|
};

/// The weights of an update, for motion X (R x 3n) in any basis of the rows. Only the first rank
/// needs them.
struct UpdateWeights {
  Eigen::MatrixXd rows;  ///< R x K: W, or Q^T W where X are coordinates in a basis Q
  Eigen::MatrixXd gram;  ///< W^T W, K x K
};

/// Products of components (K x 3n) that ADMM has not seen yet: U = 0.
template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const BlockSource<Scalar>& X,
                                           VertexBlocks<Scalar> components,
                                           const Reduction& reduction);

/// ADMM steps for min_C 1/2 ||X - W C||^2 + sum_k sum_i Lambda_ki |c_k^(i)|, Lambda = sparsity
/// times the `support` maps (K x n), from the components and dual variable of `last`. The problem
/// falls apart into vertices: all steps run on one block of them at a time, while it is in cache.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 7 to 9
template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const BlockSource<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options, const Reduction& reduction);

}  // namespace mimetra
