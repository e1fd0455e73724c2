#pragma once

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// Support map of distances (N): 0 up to d_min, 1 from d_max on (also at +infinity), linear in
/// between. All lengths have the same unit. Throws std::invalid_argument unless 0 <= d_min < d_max
/// and both are finite.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], section 4.1: the
/// Lambda of eq. 7 before it is multiplied by the sparsity weight lambda.
Eigen::VectorXd support_map(const Eigen::VectorXd& distances, double d_min, double d_max);

}  // namespace mimetra::geodesic
