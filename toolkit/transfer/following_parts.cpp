#include "toolkit/transfer/following_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/median.h"

namespace mimetra {

namespace {

constexpr std::size_t kLookingVertices = 200;
/// A vertex looks at so many, and at all that are farther than the nearest by no more than this
/// share of the target's size: a tooth is to move as a lip does, not as a wrinkle of it.
constexpr std::size_t kSeenVertices = 8;
constexpr double kSeenShare = 0.02;

/// Weighing by what is left settles in a few steps.
constexpr int kFollowingSteps = 8;
/// What is left of a point is seen from this share of the target's size on.
constexpr double kSeenResidual = 1e-4;

/// The rigid motion from `from` to `to` that most of the points agree on, beginning with none.
RigidTransform common_motion(const Positions& from, const Positions& to,
                             const Eigen::VectorXd& counts, double least) {
  RigidTransform motion;
  for (int step = 0; step < kFollowingSteps; ++step) {
    const Eigen::VectorXd left = (motion.apply(from) - to).rowwise().norm();
    const double scale = std::max(median({left.begin(), left.end()}), least);
    const Eigen::VectorXd weights = counts.array() / (left.array().square() + scale * scale);
    motion = rigid_fit(from, to, weights);
  }
  return motion;
}

}  // namespace

FollowingParts::FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                               const Pairing& pairing)
    : rest_(std::move(rest)), is_following_(rest_.rows(), false) {
  const ConnectedComponents components =
      connected_components(static_cast<int>(rest_.rows()), weld.welded(triangles));
  const auto part_of = [&](VertexIndex v) { return components.of_vertex[weld.representative[v]]; };
  std::vector<bool> has_partner(components.count, false), has_triangle(components.count, false);
  for (int t = 0; t < triangles.rows(); ++t) {
    has_triangle[part_of(triangles(t, 0))] = true;
    if (pairing.triangles().has_partner(t)) has_partner[part_of(triangles(t, 0))] = true;
  }
  const std::vector<VertexIndex> carried = pairing.carried_vertices();
  if (carried.size() < 3) return;
  size_ = (rest_.colwise().maxCoeff() - rest_.colwise().minCoeff()).norm();
  std::map<int, Part> parts;
  for (VertexIndex v = 0; v < rest_.rows(); ++v) {
    const int part = part_of(v);
    if (has_partner[part] || !has_triangle[part]) continue;
    is_following_[v] = true;
    parts[part].vertices.push_back(v);
  }
  for (auto& [number, part] : parts) {
    look_around(part, carried);
    parts_.push_back(std::move(part));
  }
}

void FollowingParts::look_around(Part& part, const std::vector<VertexIndex>& carried) const {
  const Positions surface = rest_(carried, Eigen::all);
  const std::size_t count = std::min(part.vertices.size(), kLookingVertices);
  std::map<VertexIndex, double> counts;
  for (std::size_t i = 0; i < count; ++i) {
    const VertexIndex from = part.vertices[i * part.vertices.size() / count];
    const Eigen::VectorXd distances = (surface.rowwise() - rest_.row(from)).rowwise().norm();
    std::vector<double> sorted(distances.begin(), distances.end());
    const auto last =
        sorted.begin() + static_cast<std::ptrdiff_t>(std::min(kSeenVertices, sorted.size()) - 1);
    std::nth_element(sorted.begin(), last, sorted.end());
    const double reach = std::max(*last, distances.minCoeff() + kSeenShare * size_);
    for (std::size_t s = 0; s < carried.size(); ++s) {
      if (distances[static_cast<Eigen::Index>(s)] <= reach) counts[carried[s]] += 1;
    }
  }
  part.counts.resize(static_cast<Eigen::Index>(counts.size()));
  for (const auto& [vertex, number] : counts) {
    part.counts[static_cast<Eigen::Index>(part.around.size())] = number;
    part.around.push_back(vertex);
  }
}

void FollowingParts::place(Eigen::Map<Positions> pose) const {
  for (const Part& part : parts_) {
    const Positions from = rest_(part.around, Eigen::all), to = pose(part.around, Eigen::all);
    const RigidTransform motion = common_motion(from, to, part.counts, kSeenResidual * size_);
    const Positions moved = motion.apply(rest_(part.vertices, Eigen::all));
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      pose.row(part.vertices[i]) = moved.row(static_cast<Eigen::Index>(i));
    }
  }
}

Eigen::VectorXd FollowingParts::with_surface(Eigen::VectorXd weights) const {
  for (const Part& part : parts_) {
    const Eigen::VectorXd around = weights(part.around);
    // Bit by bit theirs where they agree.
    const double least = around.minCoeff();
    const double mean = part.counts.dot((around.array() - least).matrix()) / part.counts.sum();
    weights(part.vertices).setConstant(std::min(least + mean, 1.0));
  }
  return weights;
}

}  // namespace mimetra
