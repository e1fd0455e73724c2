#include "toolkit/correspondence/polygon_split.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace mimetra {
namespace {

using Edge = std::pair<VertexIndex, VertexIndex>;

int corners_of(const Polygons& polygons, int face) {
  return polygons.offsets[face + 1] - polygons.offsets[face];
}

/// Edges of faces first to last - 1 that no other of them has the other way round.
std::vector<Edge> outer_edges(const Polygons& polygons, int first, int last) {
  std::vector<Edge> edges, outer;
  for (int face = first; face < last; ++face) {
    const int begin = polygons.offsets[face], end = polygons.offsets[face + 1];
    for (int corner = begin; corner < end; ++corner) {
      edges.emplace_back(polygons.corners[corner],
                         polygons.corners[corner + 1 < end ? corner + 1 : begin]);
    }
  }
  for (const Edge& edge : edges) {
    if (std::ranges::count(edges, Edge(edge.second, edge.first)) == 0) outer.push_back(edge);
  }
  return outer;
}

/// The polygon that the edges are, from the first one on; empty where they are not exactly one.
std::vector<VertexIndex> cycle_of(std::vector<Edge> edges) {
  std::vector<VertexIndex> cycle;
  while (!edges.empty()) {
    const auto next =
        cycle.empty() ? edges.begin() : std::ranges::find(edges, cycle.back(), &Edge::first);
    if (next == edges.end()) return {};
    if (cycle.empty()) cycle.push_back(next->first);
    if (std::ranges::count(edges, next->first, &Edge::first) != 1) return {};
    cycle.push_back(next->second);
    edges.erase(next);
  }
  if (cycle.size() < 2 || cycle.front() != cycle.back()) return {};
  cycle.pop_back();
  return cycle;
}

}  // namespace

std::optional<Polygons> joined_like(const Polygons& coarse, const Polygons& fine) {
  Polygons joined;
  int at = 0;
  for (int face = 0; face < coarse.size(); ++face) {
    // A polygon of c corners is worth c - 2 triangles.
    int wanted = corners_of(coarse, face) - 2;
    const int first = at;
    for (; wanted > 0 && at < fine.size(); ++at) wanted -= corners_of(fine, at) - 2;
    if (wanted != 0) return {};
    const auto cycle = cycle_of(outer_edges(fine, first, at));
    if (static_cast<int>(cycle.size()) != corners_of(coarse, face)) return {};
    joined.corners.insert(joined.corners.end(), cycle.begin(), cycle.end());
    joined.offsets.push_back(static_cast<int>(joined.corners.size()));
  }
  if (at != fine.size()) return {};
  return joined;
}

}  // namespace mimetra
