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
  /// How many vertices it has, and places of its rest pose (8 x 3), by spread_vertices(); earlier
  /// manifests have none.
  int vertices = 0;
  std::optional<Positions> places = {};
};

/// Vertices at even steps of a mesh's numbers, the first and the last among them: 8, or some twice.
std::vector<VertexIndex> spread_vertices(int vertices);

/// Of `frames` frames. Throws IoError, MismatchError.
KeptMotion read_motion(const std::string& path, int frames);

}  // namespace mimetra
