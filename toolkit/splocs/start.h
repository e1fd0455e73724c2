#pragma once

#include <vector>

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/updates.h"

namespace mimetra {

/// Initial values of the alternating decomposition.
struct Start {
  std::vector<VertexIndex> centers;  ///< vertex of each component (K); -1 if no motion was left
  VertexBlocks<double> components;   ///< C, K x 3n; zero if no motion was left
  Eigen::MatrixXd weights;           ///< W, F x K, feasible; zero if no motion was left
};

/// Greedy start, repeated options.count times. It finds the vertex that the earlier components
/// explain least (weighted by options.parts) and the strongest direction of its residual. The
/// weights along it then explain the motion around that vertex. X is F x 3n, this rank's part of
/// the mesh. Throws Cancelled.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], section 4.2
Start greedy_start(const BlockSource<double>& X, const SupportFunction& support,
                   const DecompositionOptions& options, const Context& = {});

/// Feasible weights from `w` (F) or from -w, whichever `rule` prefers.
Eigen::VectorXd oriented_weights(const Eigen::VectorXd& w, SignRule rule, bool nonnegative);

}  // namespace mimetra
