#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

enum class KeptInScenes { no, yes };

/// A model that nothing drives is one frame at rest, and what is made of it has no expressions.
/// Warns of that, unless one mesh is what is asked for, or a file that holds them (.glb, .usda)
/// where the operation keeps them there.
void warn_of_lost_expressions(const Invocation& invocation, const FrameSource& frames,
                              KeptInScenes kept);

}  // namespace mimetra
