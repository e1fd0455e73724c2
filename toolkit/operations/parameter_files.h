#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/alignment.h"

namespace mimetra {

// What parameters name by a path.

/// Positions of `path` (a mesh file), checked against a sequence's vertex count. Throws IoError,
/// MismatchError.
Positions read_rest(const std::string& path, const FrameSource& sequence);

/// A motion of `frames` frames as align's manifest keeps it. Throws IoError, MismatchError.
std::vector<RigidTransform> read_motion(const std::string& path, int frames);

}  // namespace mimetra
