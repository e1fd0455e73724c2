#include "toolkit/transfer/deformation_gradients.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "toolkit/mesh/inspection.h"

namespace mimetra {

Eigen::Matrix3d triangle_frame(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) {
  Eigen::Matrix3d frame;
  frame.col(0) = b - a;
  frame.col(1) = c - a;
  const Eigen::Vector3d normal = frame.col(0).cross(frame.col(1));
  const double length = normal.norm();
  frame.col(2) = length > 0 ? Eigen::Vector3d(normal / std::sqrt(length)) : normal;
  return frame;
}

Eigen::Matrix3d triangle_frame(const Eigen::Ref<const Positions>& positions,
                               const Triangles& triangles, int triangle) {
  const auto corners = triangles.row(triangle);
  return triangle_frame(positions.row(corners[0]), positions.row(corners[1]),
                        positions.row(corners[2]));
}

HatGradients hat_gradients(const Positions& rest, const Triangles& triangles, int triangle) {
  const Eigen::Matrix3d inverse = triangle_frame(rest, triangles, triangle).inverse();
  HatGradients gradients;
  gradients.col(1) = inverse.row(0).transpose();
  gradients.col(2) = inverse.row(1).transpose();
  gradients.col(0) = -gradients.col(1) - gradients.col(2);
  return gradients;
}

double own_share(double quality) {
  if (!(quality >= kDegenerateQuality)) return 0;
  const double share = std::min(1.0, quality / kSoundQuality);
  return share * share;
}

double target_share(double quality) {
  const double share = own_share(quality);
  return share * share;
}

double quality_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                  int triangle) {
  const auto corners = triangles.row(triangle);
  return triangle_quality(positions.row(corners[0]), positions.row(corners[1]),
                          positions.row(corners[2]));
}

namespace {

/// Length of the longest edge that two triangles share; 0 if they share none.
double shared_edge(const Positions& rest, const Triangles& triangles, int one, int other) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = triangles(one, i), b = triangles(one, (i + 1) % 3);
    const auto corners = triangles.row(other).array();
    if ((corners == a).any() && (corners == b).any()) {
      longest = std::max(longest, (rest.row(a) - rest.row(b)).norm());
    }
  }
  return longest;
}

/// Finds the triangles that supply the gradients of slivers.
class StandIns {
 public:
  using Parts = std::vector<DeformationGradients::Part>;

  /// Triangles are neighbours if they share an edge of `joined`.
  StandIns(const Positions& rest, const Triangles& triangles, const Triangles& joined)
      : rest_(rest),
        triangles_(triangles),
        joined_(joined),
        neighbors_(triangle_neighbors(static_cast<int>(rest.rows()), joined)) {}

  /// Parts of a sliver's gradient, found ring by ring.
  Parts parts_of(int sliver) const {
    const double own = share_of(sliver);
    Parts parts;
    if (own > 0) parts.push_back({sliver, own});
    std::set<int> seen = {sliver};
    std::map<int, double> ring = {{sliver, 1}};
    Parts around;
    double found = 0;
    while (!ring.empty() && found < 1 - kNegligible && seen.size() < kMostTriangles) {
      ring = next_ring(ring, seen);
      for (auto& [triangle, amount] : ring) {
        const double taken = amount * share_of(triangle);
        if (taken > 0) around.push_back({triangle, taken});
        found += taken;
        amount -= taken;
      }
    }
    for (const auto& [triangle, taken] : around) {
      parts.push_back({triangle, (1 - own) * taken / std::max(found, kScarce)});
    }
    return parts;
  }

 private:
  /// The search ends if less than this share of the gradient is missing.
  static constexpr double kNegligible = 1e-6;
  /// If the soundness found around a sliver adds up to less, the identity takes the rest.
  static constexpr double kScarce = 1e-3;
  static constexpr std::size_t kMostTriangles = 256;

  double share_of(int triangle) const { return own_share(quality_of(rest_, triangles_, triangle)); }

  /// Amounts that the triangles of a ring pass on to unseen neighbours.
  std::map<int, double> next_ring(const std::map<int, double>& ring, std::set<int>& seen) const {
    std::map<int, double> next;
    for (const auto& [triangle, amount] : ring) {
      std::vector<std::pair<int, double>> edges;
      double sum = 0;
      for (const int neighbor : neighbors_[triangle]) {
        if (seen.contains(neighbor)) continue;
        edges.emplace_back(neighbor, shared_edge(rest_, joined_, triangle, neighbor));
        sum += edges.back().second;
      }
      for (const auto& [neighbor, edge] : edges) {
        next[neighbor] += amount * (sum > 0 ? edge / sum : 1 / double(edges.size()));
      }
    }
    for (const auto& [triangle, amount] : next) seen.insert(triangle);
    return next;
  }

  const Positions& rest_;
  const Triangles& triangles_;
  const Triangles& joined_;  // defines neighbours
  std::vector<std::vector<int>> neighbors_;
};

void check_selected(int triangle, int all) {
  if (triangle >= 0 && triangle < all) return;
  throw std::invalid_argument("triangle " + std::to_string(triangle) +
                              " is selected, expected 0 to " + std::to_string(all - 1));
}

/// Partners of a triangle; itself if there are no pairs.
std::vector<Correspondence::Part> partners_of(int triangle, const Correspondence* pairs) {
  if (!pairs) return {{triangle, 1}};
  return {pairs->parts.begin() + pairs->offsets[triangle],
          pairs->parts.begin() + pairs->offsets[triangle + 1]};
}

}  // namespace

DeformationGradients::DeformationGradients(const Positions& rest, const Triangles& triangles,
                                           std::vector<int> selected, const Triangles* joined)
    : DeformationGradients(rest, triangles, nullptr, std::move(selected), joined) {}

DeformationGradients::DeformationGradients(const Positions& rest, const Triangles& triangles,
                                           const Correspondence& pairs, std::vector<int> selected,
                                           const Triangles* joined)
    : DeformationGradients(rest, triangles, &pairs, std::move(selected), joined) {}

DeformationGradients::DeformationGradients(const Positions& rest, const Triangles& triangles,
                                           const Correspondence* pairs, std::vector<int> selected,
                                           const Triangles* joined)
    : triangles_(triangles),
      selected_(std::move(selected)),
      parts_(selected_.size()),
      inverse_frames_(triangles.rows(), Eigen::Matrix3d::Identity()) {
  const auto all = pairs ? pairs->target_triangles() : static_cast<int>(triangles.rows());
  std::optional<StandIns> stand_ins;
  for (std::size_t s = 0; s < selected_.size(); ++s) {
    check_selected(selected_[s], all);
    double replaced = 0;
    for (const auto& [triangle, weight] : partners_of(selected_[s], pairs)) {
      const double own = own_share(quality_of(rest, triangles, triangle));
      if (own == 1) {
        parts_[s].push_back({triangle, weight});
        continue;
      }
      replaced += weight * (1 - own);
      if (!stand_ins) stand_ins.emplace(rest, triangles, joined ? *joined : triangles);
      for (const Part& part : stand_ins->parts_of(triangle)) {
        parts_[s].push_back({part.triangle, weight * part.share});
      }
    }
    if (replaced > 0.5) ++replaced_;
    for (const Part& part : parts_[s]) {
      inverse_frames_[part.triangle] = triangle_frame(rest, triangles, part.triangle).inverse();
    }
  }
}

Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> DeformationGradients::operator()(
    const Eigen::Ref<const Positions>& frame) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> gradients(3 * selected_.size(), 3);
  for (std::size_t s = 0; s < selected_.size(); ++s) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    double rest = 1;
    for (const Part& part : parts_[s]) {
      gradient += part.share * triangle_frame(frame, triangles_, part.triangle) *
                  inverse_frames_[part.triangle];
      rest -= part.share;
    }
    gradient.diagonal().array() += rest;
    gradients.middleRows<3>(static_cast<Eigen::Index>(3 * s)) = gradient;
  }
  return gradients;
}

DeformationGradients gradients_between(const Positions& source_rest, const Triangles& triangles,
                                       const Pairing* pairing, std::vector<int> selected,
                                       const Triangles* joined) {
  if (!pairing) return {source_rest, triangles, std::move(selected), joined};
  return {source_rest, pairing->source_triangles(), pairing->triangles(), std::move(selected),
          joined};
}

}  // namespace mimetra
