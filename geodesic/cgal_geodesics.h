#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// Distances by CGAL's own implementation of the heat method on its intrinsic Delaunay
/// triangulation (Surface_mesh_geodesic_distances_3), to compare with those of HeatGeodesics. Each
/// connected component is a mesh of its own, because CGAL takes one mean edge length for a mesh.
class CgalGeodesics {
 public:
  /// Keeps no reference to the mesh; triangles without area are left out. Throws
  /// std::invalid_argument as HeatGeodesics, and MismatchError that names the vertex where the mesh
  /// is not a manifold.
  CgalGeodesics(const Positions& positions, const Triangles& triangles);
  ~CgalGeodesics();
  CgalGeodesics(CgalGeodesics&&) noexcept;
  CgalGeodesics& operator=(CgalGeodesics&&) noexcept;

  /// Distance from the nearest of `sources` to every vertex (N), in the unit of the positions;
  /// +infinity on components without a source. Safe to call from several threads: each of them
  /// factors the systems of a component when it first asks. Throws std::out_of_range,
  /// std::invalid_argument when there is no source, and MismatchError where the heat does not reach
  /// all of a component, which is some hundred edges long.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;
  Eigen::VectorXd distances(VertexIndex source) const;

  /// As HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
