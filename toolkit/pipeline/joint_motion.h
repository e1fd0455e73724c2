#pragma once

#include <vector>

#include "toolkit/pipeline/solution.h"

namespace mimetra {

/// For prepare_source(): finds the head's motion together with the expressions of the first of the
/// targets that is solved for weights, and compares it with the stable one on vertices that were
/// held out; empty where no target is. It refers to the target.
///
/// Eight patches of the mesh are held out, one after the other: both fits see the rest of at most
/// fifty frames, and predict the patch by the motion and the expressions that they find.
///
/// What it returns throws OptionError (Topic::undetermined_axes) as placed_at(), what reading
/// throws, Cancelled.
JointSearch joint_search(const std::vector<Target>& targets, const SolveOptions& options = {});

}  // namespace mimetra
