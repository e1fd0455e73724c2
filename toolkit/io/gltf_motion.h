#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/gltf_document.h"
#include "toolkit/io/gltf_values.h"
#include "toolkit/io/scene.h"
#include "toolkit/mesh/frame_source.h"

/// Where a glTF file puts its meshes, and what its animations move. Internal to the format.
namespace mimetra {

/// A node with a mesh, or a joint, and where it stands.
struct PlacedNode {
  std::size_t node;
  std::string_view name;  ///< its own, else that of the nearest node above; in the document
  Eigen::Matrix4d world;
};

/// Nodes of a scene, depth first in the file's order. Throws IoError for one that is met twice.
std::vector<PlacedNode> placed_nodes(const GltfDocument& document);

/// A transform of each vertex: one of a node, or one blended of joints.
class Placement {
 public:
  explicit Placement(const Eigen::Matrix4d& world) : all_(world.topRows<3>()) {}
  /// A row of 12 numbers for each vertex, 3 x 4 column by column.
  explicit Placement(Frames blended) : blended_(std::move(blended)) {}

  /// Which of `vertices` vertices are mirrored. \pre there is a transform for each of them
  std::vector<bool> mirrored(Eigen::Index vertices) const;
  /// `points` in place, or as directions. \pre there is a transform for each of them
  void apply(Positions& points, bool directions) const;

 private:
  using Transform = Eigen::Matrix<double, 3, 4>;

  Transform of(Eigen::Index vertex) const;

  Transform all_ = Transform::Zero();
  Frames blended_;
};

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
