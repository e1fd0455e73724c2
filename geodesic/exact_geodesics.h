#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// Exact distances along a triangle mesh, by unfolding sequences of triangles. Paths cross edges of
/// more than two triangles, and the seam of a one-sided surface, only at vertices.
///
/// Each source takes 100 to 1000 times as long as with HeatGeodesics.
///
/// [Xin, Wang. Improving Chen and Han's algorithm on the discrete geodesic problem. ACM TOG 28(4),
/// 2009], as implemented by CGAL's Surface_mesh_shortest_path.
class ExactGeodesics {
 public:
  /// Keeps no reference to the mesh. Triangles without area are left out. Throws
  /// std::invalid_argument if a triangle has a bad index or a vertex that is not finite; the
  /// message names the first one.
  ExactGeodesics(const Positions& positions, const Triangles& triangles);
  ~ExactGeodesics();
  ExactGeodesics(ExactGeodesics&&) noexcept;
  ExactGeodesics& operator=(ExactGeodesics&&) noexcept;

  /// Distance from `source` to every vertex (N), in the unit of the positions; +infinity on other
  /// connected components. All distances are +infinity if no used triangle contains the source.
  /// Several threads may call it. Throws std::out_of_range.
  Eigen::VectorXd distances(VertexIndex source) const;

  /// Distance from the nearest of `sources` to every vertex (N). Throws std::out_of_range, and
  /// std::invalid_argument if there is no source.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;

  /// As in HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
