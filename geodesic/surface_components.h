#pragma once

#include <limits>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// One connected component as a separate mesh without degenerate triangles.
struct SurfaceComponent {
  /// Vertices in the whole mesh, ascending. Row v of `positions` belongs to vertices[v].
  std::vector<VertexIndex> vertices;
  /// Positions relative to their centroid, so that an offset from the origin costs no digits.
  Positions positions;
  /// Triangles as rows of `positions`.
  Triangles triangles;
};

enum class Degenerate { left_out, refused };

/// A mesh split into its connected components.
struct SurfaceComponents {
  /// Throws std::invalid_argument for a bad index, for a vertex that is not finite, and for a
  /// degenerate triangle if these are refused. The message names the first such triangle.
  SurfaceComponents(const Positions& positions, const Triangles& triangles, Degenerate degenerate);

  /// Rows of `sources` in each component. Throws std::out_of_range for a bad source, which the
  /// message names, and std::invalid_argument if there is no source.
  std::vector<std::vector<VertexIndex>> rows_of(std::span<const VertexIndex> sources) const;

  /// Distances (N) that `method(component, rows)` computes from rows of each component with a
  /// source; +infinity on other components. Throws as rows_of().
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

  /// Components in the order of their lowest vertices.
  std::vector<SurfaceComponent> components;
  /// Component of each vertex, and its row there; -1 for vertices without a triangle.
  std::vector<int> component_of;
  std::vector<VertexIndex> row_of;
  int degenerate_triangles = 0;
  std::vector<VertexIndex> vertices_without_face;
};

}  // namespace mimetra::geodesic
