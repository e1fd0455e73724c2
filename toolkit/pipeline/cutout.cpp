#include "toolkit/pipeline/cutout.h"

#include <utility>

namespace mimetra {
namespace {

/// Some vertices of another source.
class KeptVertices : public FrameSource {
 public:
  KeptVertices(std::shared_ptr<const FrameSource> whole, std::vector<VertexIndex> kept,
               Connectivity connectivity)
      : FrameSource(whole->header()), whole_(std::move(whole)), kept_(std::move(kept)) {
    header_.connectivity = std::make_shared<const Connectivity>(std::move(connectivity));
    header_.rest = Positions(whole_->rest()(kept_, Eigen::all));
    header_.rest_is_known = true;
  }

  bool is_quick() const override { return whole_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    const FrameBlock whole(*whole_, first, static_cast<int>(poses.rows()));
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      poses.middleCols(3 * i, 3) = whole.poses().middleCols(3 * kept_[i], 3);
    }
  }

  std::shared_ptr<const FrameSource> whole_;
  std::vector<VertexIndex> kept_;
};

}  // namespace

Cutout::Cutout(const std::vector<bool>& inside) : position_(inside.size(), -1) {
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (!inside[v]) continue;
    position_[v] = vertices();
    kept_.push_back(static_cast<VertexIndex>(v));
  }
}

std::shared_ptr<const FrameSource> Cutout::of(std::shared_ptr<const FrameSource> whole) const {
  std::vector<int> triangles;
  for (int t = 0; t < whole->triangles().rows(); ++t) {
    const auto corners = whole->triangles().row(t);
    if (position_[corners[0]] >= 0 && position_[corners[1]] >= 0 && position_[corners[2]] >= 0) {
      triangles.push_back(t);
    }
  }
  const Triangles kept = whole->triangles()(triangles, Eigen::all).unaryExpr([this](VertexIndex v) {
    return position_[v];
  });
  return std::make_shared<const KeptVertices>(std::move(whole), kept_,
                                              Connectivity::from_triangles(vertices(), kept));
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

Components Cutout::put_back(Components components, const FrameSource& whole) const {
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
