#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/alignment.h"

namespace mimetra {

// What parameters name by a path.

/// Positions of `path` (a mesh file), checked against a sequence's vertex count. Throws IoError,
/// MismatchError.
Positions read_rest(const std::string& path, const FrameSource& sequence);

/// A motion as align's manifest keeps it.
struct KeptMotion {
  std::vector<RigidTransform> transforms;
  /// Of the box around the aligned sequence's rest pose; earlier manifests have none.
  std::optional<Eigen::Vector3d> extent = {};
};

/// Of `frames` frames. Throws IoError, MismatchError.
KeptMotion read_motion(const std::string& path, int frames);

}  // namespace mimetra
