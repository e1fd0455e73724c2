#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "toolkit/formats/gltf/gltf_document.h"
#include "toolkit/formats/gltf/gltf_values.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/mesh/frame_source.h"

/// Placement of meshes in a glTF file, and the effect of its animations. Internal to the format.
namespace mimetra {

/// A node and its transform in the scene.
struct PlacedNode {
  std::size_t node;
  std::string_view name;  ///< own or nearest ancestor's name, stored in the document
  Eigen::Matrix4d world;
};

/// Nodes of the scene, depth first in the file's order. Throws IoError if a node is met twice.
std::vector<PlacedNode> placed_nodes(const GltfDocument& document);

/// Transform of each vertex: one for a whole node, or one per vertex blended from joints.
class Placement {
 public:
  explicit Placement(const Eigen::Matrix4d& world) : all_(world.topRows<3>()) {}
  /// One row of 12 numbers per vertex, a 3 x 4 matrix column by column.
  explicit Placement(Frames blended) : blended_(std::move(blended)) {}

  /// One flag per vertex, true if its transform mirrors. \pre each of the `vertices` has a
  /// transform
  std::vector<bool> mirrored(Eigen::Index vertices) const;
  /// Transforms `points` in place; `directions` omits the translation. \pre each has a transform
  void apply(Positions& points, bool directions) const;

 private:
  using Transform = Eigen::Matrix<double, 3, 4>;

  Transform of(Eigen::Index vertex) const;

  Transform all_ = Transform::Zero();
  Frames blended_;
};

struct GltfMotion {
  /// Weight curve of each node's mesh; null if nothing drives it.
  std::vector<std::shared_ptr<const WeightCurve>> weights;
  /// Nodes whose transforms are animated.
  std::set<std::size_t> moved;
  /// Names of the animations that `weights` come from.
  std::set<std::string> clips;
  /// Names of animations that are left out because one of `clips` drives the same weights.
  std::set<std::string> other_clips;
  /// Animation pointers to weights that are not read.
  std::set<std::string> unread;
};

/// Reads one clip for the `shown` nodes. Animations that drive weights of different nodes belong
/// together. An animation that drives any weights of an earlier one is another clip and is left out
/// as a whole.
///
/// Animations with several keys come before poses of one key. If the chosen animations hold still,
/// moving ones come first instead. Throws IoError.
GltfMotion gltf_motion(const GltfDocument& document, GltfValues& values,
                       const std::set<std::size_t>& shown);

}  // namespace mimetra
