#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "toolkit/io/gltf_values.h"
#include "toolkit/io/scene.h"

/// What the animations of a glTF file move. Internal to the format.
namespace mimetra {

struct GltfMotion {
  /// Curves of the weights of each node's mesh; null where nothing drives them.
  std::vector<std::shared_ptr<const WeightCurve>> weights;
  /// Nodes that move as a whole.
  std::set<std::size_t> moved;
  /// Animations that drive weights which another one drives.
  std::set<std::string> other_clips;
  /// What drives weights in a way that is not read.
  std::set<std::string> unread;
};

/// One clip: animations that drive weights of different nodes belong together, and one that drives
/// any weights which an earlier one drives is another clip, of which nothing is taken. Animations
/// of several keys come before poses of one. Throws IoError.
GltfMotion gltf_motion(const GltfDocument& document, GltfValues& values);

}  // namespace mimetra
