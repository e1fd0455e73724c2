#include "toolkit/mesh/edge_graph.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace mimetra {

EdgeGraph::EdgeGraph(const Positions& positions, const Triangles& triangles)
    : edges_(positions.rows()) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = triangles(t, c), b = triangles(t, (c + 1) % 3);
      if (a == b) continue;
      const double length = (positions.row(a) - positions.row(b)).norm();
      edges_[a].push_back({b, length});
      edges_[b].push_back({a, length});
    }
  }
}

std::map<VertexIndex, double> EdgeGraph::within(double reach,
                                                const std::vector<VertexIndex>& from) const {
  using Front = std::pair<double, VertexIndex>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  for (const VertexIndex v : from) fronts.emplace(0, v);
  std::map<VertexIndex, double> distances;
  while (!fronts.empty()) {
    const auto [distance, vertex] = fronts.top();
    fronts.pop();
    if (!distances.try_emplace(vertex, distance).second) continue;
    for (const auto& [to, length] : edges_[vertex]) {
      if (distance + length <= reach && !distances.contains(to)) {
        fronts.emplace(distance + length, to);
      }
    }
  }
  return distances;
}

double EdgeGraph::longest_edge(VertexIndex vertex) const {
  double longest = 0;
  for (const Edge& edge : edges_[vertex]) longest = std::max(longest, edge.length);
  return longest;
}

}  // namespace mimetra
