#pragma once

#include <mimetra/mesh/mesh_sequence.h>

namespace mimetra {

struct AdmmOptions {
  double sparsity;  ///< lambda
  double rho;
  int steps;
  int threads = 0;  ///< 0 for all there are; the result does not depend on it
};

/// Components after an update, with all that the next weights and the energy need of them.
struct ComponentUpdate {
  Frames C;            ///< components, K x 3N
  Frames U;            ///< scaled dual variable of ADMM, K x 3N; it persists over the updates
  Eigen::MatrixXd P;   ///< X C^T, F x K
  Eigen::MatrixXd H;   ///< C C^T, K x K
  double penalty = 0;  ///< sum_k sum_i Lambda_ki |c_k^(i)|
};

/// Products of components (K x 3N) that ADMM has not seen yet: U = 0.
ComponentUpdate initial_components(const Frames& X, Frames components);

/// ADMM steps for min_C 1/2 ||X - W C||^2 + sum_k sum_i Lambda_ki |c_k^(i)|, Lambda = sparsity
/// times the `support` maps (K x N), from the components and dual variable of `last`. The problem
/// falls apart into vertices: all steps run on one block of them at a time, while it is in cache.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 7 to 9
ComponentUpdate updated_components(const Frames& X, const Eigen::MatrixXd& W,
                                   const Eigen::MatrixXd& support, ComponentUpdate last,
                                   const AdmmOptions& options);

}  // namespace mimetra
