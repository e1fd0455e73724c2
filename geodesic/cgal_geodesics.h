#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

/// Distances by CGAL's heat method on its intrinsic Delaunay triangulation
/// (Surface_mesh_geodesic_distances_3), for comparison with HeatGeodesics. Each connected component
/// becomes a mesh of its own, because CGAL uses one mean edge length per mesh.
class CgalGeodesics {
 public:
  /// Keeps no reference to the mesh. Triangles without area are left out. Throws
  /// std::invalid_argument as HeatGeodesics, and MismatchError if the mesh is not a manifold; the
  /// message names the vertex.
  CgalGeodesics(const Positions& positions, const Triangles& triangles);
  ~CgalGeodesics();
  CgalGeodesics(CgalGeodesics&&) noexcept;
  CgalGeodesics& operator=(CgalGeodesics&&) noexcept;

  /// Distance from the nearest of `sources` to every vertex (N), in the unit of the positions;
  /// +infinity on components without a source.
  ///
  /// Several threads may call it. Concurrent queries on a component each factor its systems once;
  /// later queries reuse them. Throws std::out_of_range, std::invalid_argument if there is no
  /// source, and std::runtime_error if CGAL's flips do not end. Throws MismatchError if the heat
  /// fades before it reaches all of a component, which takes some hundred edges.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;
  Eigen::VectorXd distances(VertexIndex source) const;

  /// As in HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
