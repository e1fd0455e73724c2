#include "toolkit/correspondence/pairing.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/similarity.h"

namespace mimetra {
namespace {

/// Half of the weight, with a tolerance for rounding.
constexpr double kHalf = 0.5 - 1e-9;

void check_pairs(const TriMesh& source, const TriMesh& target, const Correspondence& pairs) {
  const auto from = static_cast<int>(source.connectivity.triangles.rows());
  const auto to = static_cast<int>(target.connectivity.triangles.rows());
  if (pairs.source_triangles == from && pairs.target_triangles() == to) return;
  throw MismatchError("the correspondence is of " + std::to_string(pairs.source_triangles) +
                      " triangles and " + std::to_string(pairs.target_triangles()) +
                      ", the source has " + std::to_string(from) + ", the target " +
                      std::to_string(to));
}

/// Source's rest pose, placed over the target by the pairs. Unchanged if the pairs do not determine
/// a similarity.
Positions placed_over(const TriMesh& source, const TriMesh& target, const Correspondence& pairs) {
  const Positions middles = centroids(source.positions, source.connectivity.triangles);
  const Positions places = centroids(target.positions, target.connectivity.triangles);
  Positions from(pairs.parts.size(), 3), to(pairs.parts.size(), 3);
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
      from.row(p) = middles.row(pairs.parts[p].triangle);
      to.row(p) = places.row(t);
    }
  }
  try {
    return similarity_fit(from, to).apply(source.positions);
  } catch (const MismatchError&) {
    return source.positions;  // a few collinear triangles: corners keep their order
  }
}

/// Returns true if the paired triangles of most of the target's surface face away from their
/// partners.
bool leads_other_way(const Positions& placed, const Triangles& triangles, const TriMesh& target,
                     const Correspondence& pairs) {
  const Positions from = triangle_normals(placed, triangles),
                  to = triangle_normals(target.positions, target.connectivity.triangles);
  double facing = 0;
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
      const auto [partner, weight] = pairs.parts[p];
      facing += weight * from.row(partner).stableNormalized().dot(to.row(t));
    }
  }
  return facing < 0;
}

/// Triangles with the opposite order of corners.
Triangles backwards(Triangles triangles) {
  triangles.col(1).swap(triangles.col(2));
  return triangles;
}

/// Vectors from the centroid to each corner, one a column.
Eigen::Matrix3d corner_directions(const Positions& positions, const Triangles& triangles,
                                  int triangle) {
  Eigen::Matrix3d corners;
  for (int c = 0; c < 3; ++c) {
    corners.col(c) = positions.row(triangles(triangle, c)).transpose();
  }
  const Eigen::Vector3d middle = corners.rowwise().mean();
  corners.colwise() -= middle;
  return corners;
}

/// Rotation of the source triangle's corners against the target's: 0, 1 or 2. It is 0 unless
/// another number fits clearly better.
int turn_of(const Eigen::Matrix3d& source, const Eigen::Matrix3d& target) {
  constexpr double kClearly = 1e-6;
  int best = 0;
  double most = 0;
  for (int turn = 0; turn < 3; ++turn) {
    double product = 0;
    for (int c = 0; c < 3; ++c) product += source.col((c + turn) % 3).dot(target.col(c));
    if (turn == 0 || product > most + kClearly * source.norm() * target.norm()) {
      most = product;
      best = turn;
    }
  }
  return best;
}

}  // namespace

bool is_over(const Correspondence& pairs, int target_triangle,
             const std::function<bool(int)>& is_selected) {
  double weight = 0;
  for (int p = pairs.offsets[target_triangle]; p < pairs.offsets[target_triangle + 1]; ++p) {
    if (is_selected(pairs.parts[p].triangle)) weight += pairs.parts[p].weight;
  }
  return weight >= kHalf;
}

std::vector<int> triangles_over(const Correspondence& pairs, const std::vector<int>& selected) {
  std::vector<bool> is_selected(pairs.source_triangles, false);
  for (const int triangle : selected) is_selected[triangle] = true;
  std::vector<int> over;
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    if (is_over(pairs, t, [&](int triangle) { return is_selected[triangle]; })) over.push_back(t);
  }
  return over;
}

Pairing::Pairing(const TriMesh& source, const TriMesh& target, Correspondence pairs)
    : pairs_(std::move(pairs)),
      source_triangles_(source.connectivity.triangles),
      source_vertices_(static_cast<int>(source.positions.rows())) {
  check_pairs(source, target, pairs_);
  const Triangles& triangles = target.connectivity.triangles;
  const Positions placed = placed_over(source, target, pairs_);
  const Triangles facing = leads_other_way(placed, source_triangles_, target, pairs_)
                               ? backwards(source_triangles_)
                               : source_triangles_;
  std::vector<std::map<VertexIndex, double>> weights(target.positions.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::Matrix3d here = corner_directions(target.positions, triangles, t);
    for (int p = pairs_.offsets[t]; p < pairs_.offsets[t + 1]; ++p) {
      const auto [partner, weight] = pairs_.parts[p];
      const int turn = turn_of(corner_directions(placed, facing, partner), here);
      for (int c = 0; c < 3; ++c) {
        weights[triangles(t, c)][facing(partner, (c + turn) % 3)] += weight;
      }
    }
  }
  for (const std::map<VertexIndex, double>& of_vertex : weights) {
    double sum = 0;
    for (const auto& [vertex, weight] : of_vertex) sum += weight;
    for (const auto& [vertex, weight] : of_vertex) carriers_.push_back({vertex, weight / sum});
    offsets_.push_back(static_cast<int>(carriers_.size()));
  }
}

std::span<const Pairing::Carrier> Pairing::carriers(VertexIndex target_vertex) const {
  return std::span(carriers_).subspan(offsets_[target_vertex],
                                      offsets_[target_vertex + 1] - offsets_[target_vertex]);
}

bool Pairing::is_one_to_one() const {
  const auto at_most_one = [](const std::vector<int>& offsets) {
    for (std::size_t i = 1; i < offsets.size(); ++i) {
      if (offsets[i] - offsets[i - 1] > 1) return false;
    }
    return true;
  };
  return at_most_one(offsets_) && at_most_one(pairs_.offsets);
}

std::vector<int> Pairing::with_gaps(std::vector<int> selected, const Triangles& triangles) const {
  const auto neighbors = triangle_neighbors(target_vertices(), triangles);
  std::vector<bool> is_selected(triangles.rows(), false), is_seen(triangles.rows(), false);
  for (const int t : selected) is_selected[t] = true;
  for (int first = 0; first < triangles.rows(); ++first) {
    if (is_seen[first] || is_selected[first] || pairs_.has_partner(first)) continue;
    std::vector<int> gap = {first};
    is_seen[first] = true;
    int around = 0, selected_around = 0;
    for (std::size_t next = 0; next < gap.size(); ++next) {
      for (const int t : neighbors[gap[next]]) {
        if (pairs_.has_partner(t)) {
          ++around;
          if (is_selected[t]) ++selected_around;
        } else if (!is_seen[t]) {
          is_seen[t] = true;
          gap.push_back(t);
        }
      }
    }
    if (around > 0 && 2 * selected_around >= around) {
      selected.insert(selected.end(), gap.begin(), gap.end());
    }
  }
  std::ranges::sort(selected);
  return selected;
}

std::vector<VertexIndex> Pairing::carried_vertices() const {
  std::vector<VertexIndex> carried;
  for (VertexIndex v = 0; v < target_vertices(); ++v) {
    if (!carriers(v).empty()) carried.push_back(v);
  }
  return carried;
}

Positions Pairing::carried(const Eigen::Ref<const Positions>& pose,
                           const std::vector<VertexIndex>& vertices) const {
  Positions places = Positions::Zero(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (const auto& [vertex, weight] : carriers(vertices[i])) {
      places.row(static_cast<Eigen::Index>(i)) += weight * pose.row(vertex);
    }
  }
  return places;
}

std::vector<bool> Pairing::over(const std::vector<bool>& source_vertices) const {
  std::vector<bool> is_inside(target_vertices(), false);
  for (VertexIndex v = 0; v < target_vertices(); ++v) {
    double weight = 0;
    for (const Carrier& carrier : carriers(v)) {
      if (source_vertices[carrier.vertex]) weight += carrier.weight;
    }
    is_inside[v] = weight >= kHalf;
  }
  return is_inside;
}

std::vector<int> with_partners(std::vector<int> triangles, const Pairing* pairing) {
  if (!pairing) return triangles;
  std::erase_if(triangles, [&](int t) {
    return t >= 0 && t < pairing->triangles().target_triangles() &&
           !pairing->triangles().has_partner(t);
  });
  return triangles;
}

void check_sizes(const Positions& source_rest, const Positions& target_rest,
                 const Pairing* pairing) {
  const auto sizes = [](Eigen::Index source, Eigen::Index target) {
    return "the source has " + std::to_string(source) + " vertices, the target " +
           std::to_string(target);
  };
  const std::string found = sizes(source_rest.rows(), target_rest.rows());
  if (!pairing) {
    if (source_rest.rows() == target_rest.rows()) return;
    throw MismatchError(found + "; both need the same connectivity");
  }
  const std::string expected = sizes(pairing->source_vertices(), pairing->target_vertices());
  if (found != expected) throw MismatchError(found + "; in their pairing " + expected);
}

}  // namespace mimetra
