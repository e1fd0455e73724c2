#pragma once

#include <functional>
#include <memory>

#include <mimetra/geodesic/heat_geodesics.h>
#include <mimetra/mesh/weld.h>

namespace mimetra {

/// Distances from a vertex to all vertices (N), +infinity where there is no way. What the
/// decomposition and the regions ask for.
using DistanceFunction = std::function<Eigen::VectorXd(VertexIndex)>;

enum class GeodesicMethod { heat, heat_direct, exact };

/// Distances along a surface whose coinciding vertices are welded, so that they pass across UV
/// seams. Each vertex is computed once and kept; copies share what they know.
class SurfaceDistances {
 public:
  /// Keeps no reference to the mesh. Throws std::invalid_argument as HeatGeodesics does.
  SurfaceDistances(const Positions& positions, const Triangles& triangles, const Weld& weld,
                   GeodesicMethod method = GeodesicMethod::heat);

  /// Distances from `source` (N). Safe to call from several threads. Throws std::out_of_range.
  Eigen::VectorXd operator()(VertexIndex source) const;

  /// Vertices asked for so far, each computed once.
  int computed() const;
  /// As HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace mimetra
