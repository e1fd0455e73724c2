#pragma once

#include <vector>

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/updates.h"

namespace mimetra {

/// Where the alternation of the decomposition begins.
struct Start {
  std::vector<VertexIndex> centers;  ///< vertex that each component was made for (K); -1: none left
  VertexBlocks<double> components;   ///< C, K x 3n; zero where none was left
  Eigen::MatrixXd weights;           ///< W, F x K, feasible; zero where none was left
};

/// Greedy start, options.count times: the vertex that the earlier components explain least (as
/// options.parts weighs it), the strongest direction of its residual, and what its weights explain
/// around it. X is F x 3n, this rank's part of the mesh. Throws Cancelled.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], section 4.2
Start greedy_start(const BlockSource<double>& X, const SupportFunction& support,
                   const DecompositionOptions& options, const Context& = {});

/// Feasible weights of a start from `w` (F) or from -w, whichever `rule` prefers.
Eigen::VectorXd oriented_weights(const Eigen::VectorXd& w, SignRule rule, bool nonnegative);

}  // namespace mimetra
