#include "toolkit/mesh/face_order.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "toolkit/mesh/disjoint_sets.h"

namespace mimetra {

namespace {

std::span<const int> corners_of(const Polygons& polygons, int face) {
  const auto first = static_cast<std::size_t>(polygons.offsets[std::size_t(face)]);
  const auto last = static_cast<std::size_t>(polygons.offsets[std::size_t(face) + 1]);
  return std::span(polygons.corners).subspan(first, last - first);
}

/// Normal form of a polygon: it starts at the lowest corner, in the direction that sorts first.
struct Canonical {
  std::vector<int> corners;
  bool is_turned = false;  // the direction is opposite to the winding
};

Canonical canonical(std::span<const int> corners) {
  Canonical least;
  const int lowest = *std::ranges::min_element(corners);
  for (std::size_t start = 0; start < corners.size(); ++start) {
    if (corners[start] != lowest) continue;
    std::vector<int> around(corners.begin(), corners.end());
    std::rotate(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(start), around.end());
    std::vector<int> turned = around;
    std::reverse(turned.begin() + 1, turned.end());
    if (least.corners.empty() || around < least.corners) least = {std::move(around), false};
    if (turned < least.corners) least = {std::move(turned), true};
  }
  return least;
}

class PolygonIndex {
 public:
  explicit PolygonIndex(const Polygons& polygons) {
    known_.reserve(static_cast<std::size_t>(polygons.size()));
    for (int face = 0; face < polygons.size(); ++face) {
      known_.emplace_back(canonical(corners_of(polygons, face)), face);
    }
    std::ranges::sort(known_, {}, corners);
  }

  /// Whether the mesh contains a polygon twice.
  bool repeats() const { return std::ranges::adjacent_find(known_, {}, corners) != known_.end(); }

  struct Found {
    int face;
    bool is_turned;
  };
  std::optional<Found> find(std::span<const int> polygon) const {
    const Canonical wanted = canonical(polygon);
    const auto found = std::ranges::lower_bound(known_, wanted.corners, {}, corners);
    if (found == known_.end() || corners(*found) != wanted.corners) return {};
    return Found{found->second, found->first.is_turned != wanted.is_turned};
  }

 private:
  using Known = std::pair<Canonical, int>;
  static const std::vector<int>& corners(const Known& known) { return known.first.corners; }

  std::vector<Known> known_;
};

/// Assignment of the polygons of a mesh to polygons of a coarser mesh, or of one with the same
/// polygons.
struct Split {
  std::vector<int> whole;               ///< coarser polygon that contains each finer polygon
  std::vector<bool> is_turned;          ///< whether a coarser polygon is wound against its parts
  std::vector<std::vector<int>> parts;  ///< finer polygons of each coarser polygon, ascending
};

struct PolygonEdge {
  int low, high;
  bool leads_up;
  int face;

  std::pair<int, int> ends() const { return {low, high}; }
};

std::vector<PolygonEdge> sorted_edges(const Polygons& polygons, const std::vector<int>& faces) {
  std::vector<PolygonEdge> edges;
  for (const int face : faces) {
    const auto corners = corners_of(polygons, face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
      edges.push_back({low, high, corners[i] == low, face});
    }
  }
  std::ranges::sort(edges, {}, &PolygonEdge::ends);
  return edges;
}

/// Groups of faces that are connected by edges that no polygon of `wholes` has. Returns none unless
/// each such edge belongs to two of the faces, once in each direction.
std::optional<std::vector<std::vector<int>>> joined_by_inner_edges(const Polygons& fine,
                                                                   const std::vector<int>& faces,
                                                                   const Polygons& coarse,
                                                                   const std::vector<int>& wholes) {
  const std::vector<PolygonEdge> outer = sorted_edges(coarse, wholes);
  const std::vector<PolygonEdge> edges = sorted_edges(fine, faces);
  DisjointSets joined(fine.size());
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [first](const PolygonEdge& edge) {
      return edge.ends() != first->ends();
    });
    const bool is_outer = std::ranges::binary_search(outer, first->ends(), {}, &PolygonEdge::ends);
    if (!is_outer) {
      if (last - first != 2 || first->leads_up == (first + 1)->leads_up) return {};
      joined.join(first->face, (first + 1)->face);
    }
    first = last;
  }
  std::map<int, std::vector<int>> groups;
  for (const int face : faces) groups[joined.lowest(face)].push_back(face);
  std::vector<std::vector<int>> parts;
  parts.reserve(groups.size());
  for (auto& [lowest, group] : groups) parts.push_back(std::move(group));
  return parts;
}

/// Returns none unless every polygon of `coarse` is a polygon of `fine` or is cut into several that
/// are wound the same way. Also returns none if a polygon occurs twice.
std::optional<Split> split_of(const Polygons& coarse, const Polygons& fine) {
  const auto wholes = static_cast<std::size_t>(coarse.size());
  const PolygonIndex index(coarse);
  if (index.repeats()) return {};
  Split split{std::vector<int>(static_cast<std::size_t>(fine.size())),
              std::vector<bool>(wholes, false), std::vector<std::vector<int>>(wholes)};
  const auto take = [&split](const PolygonIndex::Found& found, const std::vector<int>& parts) {
    std::vector<int>& taken = split.parts[std::size_t(found.face)];
    if (!taken.empty()) return false;
    taken = parts;
    split.is_turned[std::size_t(found.face)] = found.is_turned;
    for (const int part : parts) split.whole[std::size_t(part)] = found.face;
    return true;
  };
  std::vector<int> cut, uncovered;
  for (int face = 0; face < fine.size(); ++face) {
    const auto found = index.find(corners_of(fine, face));
    if (!found) {
      cut.push_back(face);
    } else if (!take(*found, {face})) {
      return {};
    }
  }
  for (int whole = 0; whole < coarse.size(); ++whole) {
    if (split.parts[std::size_t(whole)].empty()) uncovered.push_back(whole);
  }
  const auto groups = joined_by_inner_edges(fine, cut, coarse, uncovered);
  if (!groups || groups->size() != uncovered.size()) return {};
  for (const std::vector<int>& group : *groups) {
    const std::vector<VertexIndex> around = outline(fine, group);
    const auto found = around.empty() ? std::nullopt : index.find(around);
    if (!found) return {};
    // A polygon with c corners consists of c - 2 triangles.
    std::ptrdiff_t missing = std::ssize(around) - 2;
    for (const int part : group) missing -= std::ssize(corners_of(fine, part)) - 2;
    if (missing != 0 || !take(*found, group)) return {};
  }
  return split;
}

/// Polygon of `parts` that shares the most corners with triangle `t`; ties go to the first.
int nearest_to(const Triangles& triangles, Eigen::Index t, const Polygons& polygons,
               const std::vector<int>& parts) {
  const auto shared = [&](int part) {
    const auto corners = corners_of(polygons, part);
    return std::ranges::count_if(triangles.row(t),
                                 [&](int v) { return std::ranges::count(corners, v) > 0; });
  };
  return *std::ranges::max_element(parts, {}, shared);
}

}  // namespace

std::vector<VertexIndex> outline(const Polygons& polygons, const std::vector<int>& faces) {
  using Edge = std::pair<VertexIndex, VertexIndex>;
  std::vector<Edge> edges;
  for (const int face : faces) {
    const auto corners = corners_of(polygons, face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      edges.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    }
  }
  std::vector<Edge> sorted = edges;
  std::ranges::sort(sorted);
  std::map<VertexIndex, VertexIndex> outer;
  std::vector<VertexIndex> cycle;
  for (const auto& [from, to] : edges) {
    if (std::ranges::binary_search(sorted, Edge(to, from))) continue;
    if (cycle.empty()) cycle.push_back(from);
    if (!outer.emplace(from, to).second) return {};
  }
  while (!outer.empty()) {
    const auto edge = outer.extract(cycle.back());
    if (edge.empty()) return {};
    cycle.push_back(edge.mapped());
  }
  if (cycle.empty() || cycle.back() != cycle.front()) return {};
  cycle.pop_back();
  return cycle;
}

std::optional<Connectivity> in_order_of(const Connectivity& reference, const Connectivity& mesh) {
  if (reference.vertices != mesh.vertices) return {};
  const bool is_finer = mesh.polygons.size() > reference.polygons.size();
  const std::optional<Split> split = is_finer ? split_of(reference.polygons, mesh.polygons)
                                              : split_of(mesh.polygons, reference.polygons);
  if (!split) return {};
  Connectivity ordered = mesh;
  ordered.triangles = reference.triangles;
  for (Eigen::Index t = 0; t < ordered.triangles.rows(); ++t) {
    const int known = reference.polygon_of_triangle[std::size_t(t)];
    const int whole = is_finer ? known : split->whole[std::size_t(known)];
    ordered.polygon_of_triangle[std::size_t(t)] =
        is_finer
            ? nearest_to(reference.triangles, t, mesh.polygons, split->parts[std::size_t(whole)])
            : whole;
    if (split->is_turned[std::size_t(whole)]) {
      std::swap(ordered.triangles(t, 1), ordered.triangles(t, 2));
    }
  }
  return ordered;
}

}  // namespace mimetra
