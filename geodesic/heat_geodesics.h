#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

struct HeatOptions {
  /// Solve on the intrinsic Delaunay triangulation, which is accurate even on slivers, instead of
  /// the mesh itself.
  bool intrinsic_delaunay = true;
  /// Leave out triangles without area (and count them) instead of refusing the mesh.
  bool skip_degenerate = true;
};

/// Distances along a triangle mesh by the heat method, diffusion time = mean edge length squared.
///
/// The constructor factors two sparse systems per connected component; each query costs two
/// back-substitutions. Queries are const and may run from several threads. Any set of triangles is
/// accepted. Heat passes across edges of more than two triangles, across vertices where sheets
/// touch, and between triangles that are wound against each other.
///
/// [Crane, Weischedel, Wardetzky. Geodesics in Heat. ACM TOG 32(5), 2013]
class HeatGeodesics {
 public:
  /// Keeps no reference to the mesh. Throws std::invalid_argument, with the number of the first
  /// such triangle, for a bad index or a vertex that is not finite. Unless options.skip_degenerate,
  /// also throws it for a repeated vertex or no area (2 A < 1e-6 of the longest side squared).
  /// Throws std::runtime_error if the system of a component cannot be factored.
  HeatGeodesics(const Positions& positions, const Triangles& triangles, const HeatOptions& = {});
  ~HeatGeodesics();
  HeatGeodesics(HeatGeodesics&&) noexcept;
  HeatGeodesics& operator=(HeatGeodesics&&) noexcept;

  /// Distance from `source` to every vertex (N), in the unit of the positions: 0 at the source,
  /// finite on its connected component, +infinity on others. Throws std::out_of_range.
  Eigen::VectorXd distances(VertexIndex source) const;

  /// Distance from the nearest of `sources` to every vertex (N). Throws std::out_of_range, and
  /// std::invalid_argument if there is no source.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;

  /// Distance from each of `sources` (S) to every vertex, N x S. Column i equals
  /// distances(sources[i]). kGroup sources cost little more than one. Throws std::out_of_range.
  Eigen::MatrixXd distances_from_each(std::span<const VertexIndex> sources) const;
  static constexpr int kGroup = 8;

  /// Number of triangles left out because they have no area or repeat a vertex.
  int degenerate_triangles() const;

  /// Vertices without a used triangle, ascending. All distances to and from them are +infinity.
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
