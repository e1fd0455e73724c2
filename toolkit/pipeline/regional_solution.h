#pragma once

#include <vector>

#include "toolkit/pipeline/solution.h"

/// The part of solve() that gives each region weights of its own.
namespace mimetra {

/// Throws std::invalid_argument where such weights cannot be found as the options say.
void check_regional(const Target& target, const SolveOptions& options);

/// Vertices of the target that lie over each region of the source.
std::vector<std::vector<VertexIndex>> regions_over(const Pairing& pairing, const Regions& regions);

/// Solves for the weights of the selection's regions and of what lies around them, given those of
/// the whole face (F x D), and puts them and their sequence into `solution`. Notes regions that are
/// not on the target.
void add_regional_weights(Solution& solution, const FrameSource& performance, const Target& target,
                          const Selection& selection, const Eigen::MatrixXd& global,
                          const SolveOptions& options);

}  // namespace mimetra
