#pragma once

#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

struct AdmmOptions {
  double sparsity;  ///< lambda
  double rho;
  int steps;
  int threads = 0;  ///< 0 for all there are; the result does not depend on it
};

/// Components after an update, with all that the next weights and the energy need of them.
template <typename Scalar>
struct ComponentUpdate {
  VertexBlocks<Scalar> C;  ///< components, K x 3N
  VertexBlocks<Scalar> U;  ///< scaled dual variable of ADMM, K x 3N; it persists over the updates
  Eigen::MatrixXd P;       ///< X C^T, R x K
  Eigen::MatrixXd H;       ///< C C^T, K x K
  double penalty = 0;      ///< sum_k sum_i Lambda_ki |c_k^(i)|
};

/// The weights of an update, for motion X (R x 3N) in any basis of the rows.
struct UpdateWeights {
  Eigen::MatrixXd rows;  ///< R x K: W, or Q^T W where X are coordinates in a basis Q
  Eigen::MatrixXd gram;  ///< W^T W, K x K
};

/// Products of components (K x 3N) that ADMM has not seen yet: U = 0.
template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const VertexBlocks<Scalar>& X,
                                           VertexBlocks<Scalar> components, int threads);

/// ADMM steps for min_C 1/2 ||X - W C||^2 + sum_k sum_i Lambda_ki |c_k^(i)|, Lambda = sparsity
/// times the `support` maps (K x N), from the components and dual variable of `last`. The problem
/// falls apart into vertices: all steps run on one block of them at a time, while it is in cache.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 7 to 9
template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const VertexBlocks<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options);

}  // namespace mimetra
