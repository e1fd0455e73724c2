#include "toolkit/transfer/following_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/surface.h"

namespace mimetra {

namespace {

/// Numbers of a part's vertices that send rays and that look for near surface vertices.
constexpr std::size_t kRayVertices = 50;
constexpr std::size_t kLookingVertices = 200;
/// Surface vertices that a vertex of a part looks at: at least this many. In addition, all that are
/// farther than the nearest by at most kSeenShare of the face's size. A tooth should move like a
/// lip and not like a wrinkle of it.
constexpr std::size_t kSeenVertices = 8;
constexpr double kSeenShare = 0.02;

/// A part is enclosed if this share of rays meets the surface, or this share meets its back.
constexpr double kEnclosedShare = 0.6;
constexpr double kBackShare = 0.3;
/// A part lies against the surface if no vertex is farther away than this share of the face's size.
constexpr double kTouchingShare = 0.02;

/// Reweighting by residuals settles in a few steps.
constexpr int kFollowingSteps = 8;
/// Lower bound of the residuals' scale, as a share of the face's size.
constexpr double kSeenResidual = 1e-4;

/// Rigid motion from `from` to `to` that most of the points agree on. The search starts from no
/// motion.
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

/// Directions to the faces, edges and corners of a cube.
std::vector<Eigen::Vector3d> ray_directions() {
  std::vector<Eigen::Vector3d> directions;
  for (const int x : {-1, 0, 1}) {
    for (const int y : {-1, 0, 1}) {
      for (const int z : {-1, 0, 1}) {
        if (x != 0 || y != 0 || z != 0) directions.emplace_back(x, y, z);
      }
    }
  }
  return directions;
}

/// Up to `most` of the vertices, evenly spread over the list.
std::vector<VertexIndex> some_of(const std::vector<VertexIndex>& vertices, std::size_t most) {
  const std::size_t count = std::min(vertices.size(), most);
  std::vector<VertexIndex> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(vertices[i * vertices.size() / count]);
  return some;
}

bool is_enclosed(const std::vector<VertexIndex>& part, const Positions& rest,
                 const ClosestSurface& surface) {
  static const std::vector<Eigen::Vector3d> directions = ray_directions();
  double all = 0, seen = 0, back = 0;
  for (const VertexIndex v : some_of(part, kRayVertices)) {
    for (const Eigen::Vector3d& direction : directions) {
      const Seen side = surface.seen_from(rest.row(v), direction);
      ++all;
      if (side != Seen::nothing) ++seen;
      if (side == Seen::back) ++back;
    }
  }
  return seen >= kEnclosedShare * all || back >= kBackShare * all;
}

bool lies_against(const std::vector<VertexIndex>& part, const Positions& rest,
                  const ClosestSurface& surface, double reach) {
  return std::ranges::all_of(part,
                             [&](VertexIndex v) { return surface.distance(rest.row(v)) <= reach; });
}

}  // namespace

FollowingParts::FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                               const Pairing& pairing)
    : rest_(std::move(rest)), without_motion_(rest_.rows(), false) {
  std::vector<bool> moves(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) moves[t] = pairing.triangles().has_partner(t);
  const std::vector<VertexIndex> carried = pairing.carried_vertices();
  if (carried.size() >= 3) find(triangles, weld, moves, carried);
}

FollowingParts::FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                               const Eigen::VectorXd& weights)
    : rest_(std::move(rest)), without_motion_(rest_.rows(), false) {
  std::vector<bool> moves(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    moves[t] = (weights(triangles.row(t)).array() > 0).any();
  }
  find(triangles, weld, moves, {});
}

/// Finds the parts without a moving triangle; `moves` has one entry a triangle (M). They follow the
/// vertices `carried`. If that is empty, they follow all vertices of the other parts.
void FollowingParts::find(const Triangles& triangles, const Weld& weld,
                          const std::vector<bool>& moves, std::vector<VertexIndex> carried) {
  const ConnectedComponents components = connected_components(triangles, weld);
  const std::vector<int>& part_of = components.of_vertex;
  std::vector<bool> part_moves(components.count, false), has_triangle(components.count, false);
  for (int t = 0; t < triangles.rows(); ++t) {
    has_triangle[part_of[triangles(t, 0)]] = true;
    if (moves[t]) part_moves[part_of[triangles(t, 0)]] = true;
  }
  const bool takes_all = carried.empty();
  std::map<int, std::vector<VertexIndex>> others;
  for (VertexIndex v = 0; v < rest_.rows(); ++v) {
    const int part = part_of[v];
    if (takes_all && part_moves[part]) carried.push_back(v);
    if (part_moves[part] || !has_triangle[part]) continue;
    without_motion_[v] = true;
    others[part].push_back(v);
  }
  if (others.empty() || carried.empty()) return;
  size_ = box_diagonal(rest_(carried, Eigen::all));
  std::vector<int> moving;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (part_moves[part_of[triangles(t, 0)]]) moving.push_back(t);
  }
  const Triangles welded = weld.welded(triangles(moving, Eigen::all));
  const ClosestSurface surface(rest_, with_area(rest_, welded));
  for (auto& [number, vertices] : others) {
    if (!is_enclosed(vertices, rest_, surface) &&
        !lies_against(vertices, rest_, surface, kTouchingShare * size_)) {
      continue;
    }
    Part part{std::move(vertices), {}, {}};
    look_around(part, carried);
    parts_.push_back(std::move(part));
  }
}

void FollowingParts::look_around(Part& part, const std::vector<VertexIndex>& carried) const {
  const Positions surface = rest_(carried, Eigen::all);
  std::map<VertexIndex, double> counts;
  for (const VertexIndex from : some_of(part.vertices, kLookingVertices)) {
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

std::vector<std::vector<VertexIndex>> FollowingParts::parts() const {
  std::vector<std::vector<VertexIndex>> lists;
  for (const Part& part : parts_) lists.push_back(part.vertices);
  return lists;
}

std::vector<double> FollowingParts::farthest(const Eigen::Ref<const Frames>& poses) const {
  std::vector<double> moves(parts_.size(), 0);
  for (Eigen::Index f = 0; f < poses.rows(); ++f) {
    const PositionsView pose(poses.row(f).data(), rest_.rows(), 3);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const VertexIndex v : parts_[p].vertices) {
        moves[p] = std::max(moves[p], (pose.row(v) - rest_.row(v)).norm());
      }
    }
  }
  return moves;
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
  for (std::size_t v = 0; v < without_motion_.size(); ++v) {
    if (without_motion_[v]) weights[static_cast<Eigen::Index>(v)] = 0;
  }
  for (const Part& part : parts_) {
    const Eigen::VectorXd around = weights(part.around);
    // If all weights are equal, the mean equals them bit by bit.
    const double least = around.minCoeff();
    const double mean = part.counts.dot((around.array() - least).matrix()) / part.counts.sum();
    weights(part.vertices).setConstant(std::min(least + mean, 1.0));
  }
  return weights;
}

}  // namespace mimetra
