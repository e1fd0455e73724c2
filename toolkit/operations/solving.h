#pragma once

#include "toolkit/mesh/progress.h"
#include "toolkit/operations/analysis.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// Parameters shared by transfer and evaluate.
std::vector<Parameter> solving_parameters();

/// Applies --source-rest and --align: the source with its neutral as rest pose, without head
/// motion.
Alignment prepare_source(const Invocation& invocation);

/// True for the vertex space of --space, and where a target has no expressions to solve for.
bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target);

/// Throws MismatchError unless the target has the source's vertices and faces.
void check_target(const MeshSequence& source, const NamedData& target);

/// A target's solution on triangles L.
struct Solution {
  MeshSequence sequence;    ///< rest pose = the target's neutral, without head motion
  Eigen::MatrixXd weights;  ///< beta, F x D; empty in vertex space
  BlendshapeConditions conditions;
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
  double seconds = 0;  ///< set-up and all frames
};

/// What a transfer looks at: triangles L, and the vertices inside the regions (empty for all).
struct Selection {
  std::vector<int> triangles;
  std::vector<bool> inside;
};

/// Solves in blendshape or vertex space, as --space says and the target allows; warns of what the
/// user should know.
Solution solve(const Invocation& invocation, const Alignment& source, const NamedData& target,
               const Selection& selection, const Progress& progress);

}  // namespace mimetra
