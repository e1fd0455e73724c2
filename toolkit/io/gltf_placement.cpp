#include "toolkit/io/gltf_placement.h"

#include <string>

#include <Eigen/LU>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

bool mirrors(const Eigen::Matrix<double, 3, 4>& transform) {
  return transform.leftCols<3>().determinant() < 0;
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const GltfDocument& document) {
  std::vector<PlacedNode> placed, open;
  for (auto root = document.roots.rbegin(); root != document.roots.rend(); ++root) {
    open.push_back({*root, {}, Eigen::Matrix4d::Identity()});
  }
  std::vector<bool> met(document.nodes.size(), false);
  while (!open.empty()) {
    PlacedNode here = std::move(open.back());
    open.pop_back();
    if (met[here.node]) {
      throw IoError(document.path, "nodes[" + std::to_string(here.node) +
                                       "] is met twice; nodes must form a tree");
    }
    met[here.node] = true;
    const GltfNode& node = document.nodes[here.node];
    here.world *= node.local;
    if (!node.name.empty()) here.name = node.name;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      open.push_back({*child, here.name, here.world});
    }
    placed.push_back(std::move(here));
  }
  return placed;
}

std::vector<bool> Placement::mirrored(Eigen::Index vertices) const {
  if (blended_.rows() == 0) {
    return std::vector<bool>(static_cast<std::size_t>(vertices), mirrors(all_));
  }
  std::vector<bool> flags;
  for (Eigen::Index v = 0; v < vertices; ++v) flags.push_back(mirrors(of(v)));
  return flags;
}

void Placement::apply(Positions& points, bool directions) const {
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Transform transform = of(v);
    Eigen::Vector3d moved = transform.leftCols<3>() * points.row(v).transpose();
    if (!directions) moved += transform.col(3);
    points.row(v) = moved;
  }
}

Placement::Transform Placement::of(Eigen::Index vertex) const {
  if (blended_.rows() == 0) return all_;
  return Eigen::Map<const Transform>(blended_.row(vertex).data());
}

}  // namespace mimetra
