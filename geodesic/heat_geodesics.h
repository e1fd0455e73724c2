#pragma once

#include <memory>
#include <span>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra::geodesic {

struct HeatOptions {
  /// Solve on the intrinsic Delaunay triangulation (accurate also on slivers), or on the mesh as
  /// is.
  bool intrinsic_delaunay = true;
  /// Leave out triangles without area (and count them) instead of refusing the mesh.
  bool skip_degenerate = true;
};

/// Distances along a triangle mesh by the heat method, diffusion time = mean edge length squared.
///
/// The constructor factors two sparse systems per connected component; each query costs two
/// back-substitutions. Queries are const and may run from several threads. Any set of triangles
/// will do: heat passes across edges of more than two triangles, across vertices where sheets
/// touch, and between triangles that run opposite ways round.
///
/// [Crane, Weischedel, Wardetzky. Geodesics in Heat. ACM TOG 32(5), 2013]
class HeatGeodesics {
 public:
  /// Keeps no reference to the mesh. Throws std::invalid_argument that names the first triangle
  /// with a bad index or a vertex that is not finite, and, unless options.skip_degenerate, the
  /// first one that repeats a vertex or has no area (2 A < 1e-6 of its longest side squared).
  HeatGeodesics(const Positions& positions, const Triangles& triangles, const HeatOptions& = {});
  ~HeatGeodesics();
  HeatGeodesics(HeatGeodesics&&) noexcept;
  HeatGeodesics& operator=(HeatGeodesics&&) noexcept;

  /// Distance from `source` to every vertex (N), in the unit of the positions: 0 at the source,
  /// finite on its connected component, +infinity on others. Throws std::out_of_range.
  Eigen::VectorXd distances(VertexIndex source) const;

  /// Distance from the nearest of `sources` to every vertex (N). Throws std::out_of_range, and
  /// std::invalid_argument when there is no source.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;

  /// Distance from each of `sources` (S) to every vertex, N x S; the columns are those that one
  /// query a source would give. kGroup of them cost little more than one. Throws std::out_of_range.
  Eigen::MatrixXd distances_from_each(std::span<const VertexIndex> sources) const;
  static constexpr int kGroup = 8;

  /// Number of triangles left out because they have no area or repeat a vertex.
  int degenerate_triangles() const;

  /// Vertices that belong to no triangle that was used, ascending; all distances there are
  /// +infinity.
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mimetra::geodesic
