#include "toolkit/pipeline/cutout.h"

#include <utility>

namespace mimetra {
namespace {

/// The coordinates of some vertices in rows of poses: R x 3N becomes R x 3n.
Frames gathered(const Frames& poses, const std::vector<VertexIndex>& vertices) {
  Frames result(poses.rows(), 3 * vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    result.middleCols(3 * i, 3) = poses.middleCols(3 * vertices[i], 3);
  }
  return result;
}

}  // namespace

Cutout::Cutout(const std::vector<bool>& inside) : position_(inside.size(), -1) {
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (!inside[v]) continue;
    position_[v] = vertices();
    kept_.push_back(static_cast<VertexIndex>(v));
  }
}

MeshSequence Cutout::of(const MeshSequence& whole) const {
  std::vector<int> triangles;
  for (int t = 0; t < whole.triangles().rows(); ++t) {
    const auto corners = whole.triangles().row(t);
    if (position_[corners[0]] >= 0 && position_[corners[1]] >= 0 && position_[corners[2]] >= 0) {
      triangles.push_back(t);
    }
  }
  const Triangles kept = whole.triangles()(triangles, Eigen::all).unaryExpr([this](VertexIndex v) {
    return position_[v];
  });
  return {Connectivity::from_triangles(vertices(), kept), gathered(whole.positions(), kept_),
          whole.known_times(), Positions(whole.rest()(kept_, Eigen::all))};
}

DistanceFunction Cutout::of(DistanceFunction distances) const {
  return [distances = std::move(distances), kept = kept_](std::span<const VertexIndex> sources) {
    std::vector<VertexIndex> in_whole;
    for (const VertexIndex source : sources) in_whole.push_back(kept[source]);
    return Eigen::MatrixXd(distances(in_whole)(kept, Eigen::all));
  };
}

std::vector<int> Cutout::of(const std::vector<int>& values) const {
  std::vector<int> kept;
  for (const VertexIndex v : kept_) kept.push_back(values[v]);
  return kept;
}

Components Cutout::put_back(Components components, const MeshSequence& whole) const {
  const Frames displacements = std::exchange(components.displacements,
                                             Frames::Zero(components.count(), whole.rest().size()));
  const Eigen::MatrixXd support = std::exchange(
      components.support, Eigen::MatrixXd::Ones(components.count(), whole.vertices()));
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    components.displacements.middleCols(3 * kept_[i], 3) = displacements.middleCols(3 * i, 3);
    components.support.col(kept_[i]) = support.col(i);
  }
  for (VertexIndex& center : components.centers) {
    if (center >= 0) center = kept_[center];
  }
  components.rest = whole.rest();
  components.triangles = whole.triangles();
  components.options.parts = {};
  return components;
}

}  // namespace mimetra
