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
  /// Animations whose weights those are.
  std::set<std::string> clips;
  /// Animations that drive weights which one of those drives.
  std::set<std::string> other_clips;
  /// What drives weights in a way that is not read.
  std::set<std::string> unread;
};

/// One clip of the nodes that are `shown`: animations that drive weights of different nodes belong
/// together, and one that drives any weights which an earlier one drives is another clip, of which
/// nothing is taken. Animations of several keys come before poses of one; where those that are read
/// hold still, one that moves is read instead. Throws IoError.
GltfMotion gltf_motion(const GltfDocument& document, GltfValues& values,
                       const std::set<std::size_t>& shown);

}  // namespace mimetra
