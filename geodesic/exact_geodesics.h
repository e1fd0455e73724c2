#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// Exact distances along a triangle mesh, by unfolding sequences of triangles. Across an edge of
/// more than two triangles, or a one-sided surface's seam, the way leads through a vertex.
///
/// Slower than HeatGeodesics by two to three orders of magnitude per source.
///
/// [Xin, Wang. Improving Chen and Han's algorithm on the discrete geodesic problem. ACM TOG 28(4),
/// 2009], as implemented by CGAL's Surface_mesh_shortest_path.
class ExactGeodesics {
 public:
  /// Keeps no reference to the mesh; triangles without area are left out. Throws
  /// std::invalid_argument that names the first triangle with a bad index or a vertex that is not
  /// finite.
  ExactGeodesics(const Positions& positions, const Triangles& triangles);
  ~ExactGeodesics();
  ExactGeodesics(ExactGeodesics&&) noexcept;
  ExactGeodesics& operator=(ExactGeodesics&&) noexcept;

  /// Distance from `source` to every vertex (N), in the unit of the positions; +infinity on other
  /// connected components, and everywhere when no triangle that was used holds the source. Safe to
  /// call from several threads. Throws std::out_of_range.
  Eigen::VectorXd distances(VertexIndex source) const;

  /// Distance from the nearest of `sources` to every vertex (N). Throws std::out_of_range, and
  /// std::invalid_argument when there is no source.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;

  /// As HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
