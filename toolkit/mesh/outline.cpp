#include "toolkit/mesh/outline.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace mimetra {

std::vector<VertexIndex> outline(const Polygons& polygons, const std::vector<int>& faces) {
  using Edge = std::pair<VertexIndex, VertexIndex>;
  std::vector<Edge> edges;
  for (const int face : faces) {
    const int begin = polygons.offsets[face], end = polygons.offsets[face + 1];
    for (int corner = begin; corner < end; ++corner) {
      edges.emplace_back(polygons.corners[corner],
                         polygons.corners[corner + 1 < end ? corner + 1 : begin]);
    }
  }
  std::vector<Edge> sorted = edges;
  std::ranges::sort(sorted);
  std::vector<Edge> outer;
  std::ranges::copy_if(edges, std::back_inserter(outer), [&sorted](const Edge& edge) {
    return !std::ranges::binary_search(sorted, Edge(edge.second, edge.first));
  });
  if (outer.empty()) return {};
  const VertexIndex first = outer.front().first;
  std::ranges::sort(outer);
  if (std::ranges::adjacent_find(outer, {}, &Edge::first) != outer.end()) return {};

  std::vector<VertexIndex> cycle;
  VertexIndex at = first;
  do {
    cycle.push_back(at);
    const auto next = std::ranges::lower_bound(outer, at, {}, &Edge::first);
    if (next == outer.end() || next->first != at || cycle.size() > outer.size()) return {};
    at = next->second;
  } while (at != first);
  if (cycle.size() != outer.size()) cycle.clear();
  return cycle;
}

}  // namespace mimetra
