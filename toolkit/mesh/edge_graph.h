#pragma once

#include <map>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A surface as its edges, to walk along. Queries are const.
class EdgeGraph {
 public:
  /// `positions` N x 3, `triangles` M x 3; vertices that are one point of the surface are to be
  /// welded before.
  EdgeGraph(const Positions& positions, const Triangles& triangles);

  /// Vertices that edges lead to within `reach` (length) of the nearest of `from`, and how far. An
  /// edge on the way is no farther from the surface's own distance than its triangles are long.
  std::map<VertexIndex, double> within(double reach, const std::vector<VertexIndex>& from) const;

  struct Edge {
    VertexIndex to;
    double length;
  };
  const std::vector<Edge>& edges(VertexIndex vertex) const { return edges_[vertex]; }
  /// Of the edges of a vertex; 0 without any.
  double longest_edge(VertexIndex vertex) const;

 private:
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace mimetra
