#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/gltf_document.h"
#include "toolkit/mesh/frame_source.h"

/// Where a glTF file puts its meshes. Internal to the format.
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

}  // namespace mimetra
