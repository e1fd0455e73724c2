#pragma once

#include <limits>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// One connected component as a mesh of its own, without degenerate triangles.
struct SurfaceComponent {
  /// Vertices of the whole mesh, ascending; row v of `positions` belongs to vertices[v].
  std::vector<VertexIndex> vertices;
  /// Relative to their centroid, so that a place far from the origin costs no digits.
  Positions positions;
  /// On rows of `positions`.
  Triangles triangles;
};

enum class Degenerate { left_out, refused };

/// A mesh taken apart.
struct SurfaceComponents {
  /// Throws std::invalid_argument that names the first triangle with a bad index or with a vertex
  /// that is not finite, and the first degenerate one where they are refused.
  SurfaceComponents(const Positions& positions, const Triangles& triangles, Degenerate degenerate);

  /// Rows of `sources` in each component. Throws std::out_of_range that names the first bad one,
  /// and std::invalid_argument when there is none.
  std::vector<std::vector<VertexIndex>> rows_of(std::span<const VertexIndex> sources) const;

  /// The distances (N) that `method(component, rows)` finds from rows of a component, on each one
  /// that has a source; +infinity elsewhere. Throws as rows_of().
  template <typename Method>
  Eigen::VectorXd distances(std::span<const VertexIndex> sources, const Method& method) const {
    const auto rows = rows_of(sources);
    Eigen::VectorXd result = Eigen::VectorXd::Constant(
        static_cast<Eigen::Index>(component_of.size()), std::numeric_limits<double>::infinity());
    for (std::size_t c = 0; c < rows.size(); ++c) {
      if (!rows[c].empty()) result(components[c].vertices) = method(c, rows[c]);
    }
    return result;
  }

  /// In the order of each one's lowest vertex.
  std::vector<SurfaceComponent> components;
  /// Component of each vertex, and its row there; -1 where no triangle holds it.
  std::vector<int> component_of;
  std::vector<VertexIndex> row_of;
  int degenerate_triangles = 0;
  std::vector<VertexIndex> vertices_without_face;
};

}  // namespace mimetra::geodesic
