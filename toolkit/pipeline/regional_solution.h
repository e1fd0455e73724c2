#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/length.h"
#include "toolkit/model/regional_animation.h"
#include "toolkit/pipeline/analysis.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/local_weights.h"

/// The part of solve() that gives each region weights of its own.
namespace mimetra {

struct RegionalOptions {
  /// Of the target, in notes.
  std::string name = {};
  /// As in SolveOptions.
  Length falloff = Length::share(0.1);
  DistanceOptions distances = {};
  LocalWeightsOptions local = {};
};

struct RegionalSolution {
  std::shared_ptr<const RegionalAnimation> animation;
  double violation = 0;  ///< of the optimality conditions
};

/// Vertices of the target that lie over each region of the source.
std::vector<std::vector<VertexIndex>> regions_over(const Pairing& pairing, const Regions& regions);

/// Solves for the weights of regions, which are lists of the target's vertices, and of what lies
/// around them, on all triangles, given those of the whole face (F x D). Notes regions that are not
/// on the target. Throws what partition_of_unity() and LocalWeights throw.
RegionalSolution solve_regions(const FrameSource& performance, const BlendshapeModel& model,
                               const std::vector<std::vector<VertexIndex>>& regions,
                               const Eigen::MatrixXd& global, const RegionalOptions& options,
                               const Context& context);

}  // namespace mimetra
