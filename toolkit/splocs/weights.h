#pragma once

#include <Eigen/Core>

namespace mimetra {

/// `weights` (F) made feasible: negative entries become 0 where `nonnegative`, then the largest
/// magnitude becomes 1 (a zero vector stays).
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 3 and 4
Eigen::VectorXd feasible_weights(const Eigen::VectorXd& weights, bool nonnegative);

/// One Gauss-Seidel sweep over the columns of W (F x K) for fixed components C, from the products
/// P = X C^T (F x K) and H = C C^T (K x K). A component without energy gets no weights.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 6
Eigen::MatrixXd updated_weights(Eigen::MatrixXd W, const Eigen::MatrixXd& P,
                                const Eigen::MatrixXd& H, bool nonnegative);

}  // namespace mimetra
