#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "geodesic/heat_geodesics.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Distances from each of S source vertices to all N vertices (N x S), +infinity if there is no
/// path. The decomposition and the regions call it.
using DistanceFunction = std::function<Eigen::MatrixXd(std::span<const VertexIndex>)>;

/// Calls `distances` (N) for one vertex after the other, from the calling thread.
DistanceFunction one_by_one(std::function<Eigen::VectorXd(VertexIndex)> distances);

enum class GeodesicMethod {
  heat,         ///< HeatGeodesics
  heat_direct,  ///< HeatGeodesics on the mesh's own triangles
  exact,        ///< ExactGeodesics
  cgal          ///< CgalGeodesics
};

constexpr std::string_view choice_name(GeodesicMethod value) {
  switch (value) {
    case GeodesicMethod::heat:
      return "heat";
    case GeodesicMethod::heat_direct:
      return "heat-direct";
    case GeodesicMethod::exact:
      return "exact";
    case GeodesicMethod::cgal:
      return "cgal";
  }
  return {};
}

/// Distances along a surface. Coinciding vertices are welded, so that distances pass across UV
/// seams. The latest distances are kept; copies share them.
class SurfaceDistances {
 public:
  /// Maximum size of the kept distances in bytes: all sources of a face, or 61 sources of a million
  /// vertices.
  static constexpr std::size_t kKeptBytes = std::size_t{1} << 29;

  /// Keeps no reference to the mesh, and only the number of threads of the context. Throws
  /// std::invalid_argument as HeatGeodesics does, or if the weld has another number of vertices.
  SurfaceDistances(const Positions& positions, const Triangles& triangles, const Weld& weld,
                   GeodesicMethod method = GeodesicMethod::heat, const Context& context = {})
      : SurfaceDistances(positions, triangles, weld, method, kKeptBytes, context) {}
  SurfaceDistances(const Positions& positions, const Triangles& triangles, const Weld& weld,
                   GeodesicMethod method, std::size_t kept_bytes, const Context& context = {});

  /// Distances from each of `sources` (N x S). Missing ones are computed in groups. Safe to call
  /// from several threads. Throws std::out_of_range.
  Eigen::MatrixXd operator()(std::span<const VertexIndex> sources) const;
  /// Distances from each of `sources` (N x S), computed again and not kept. Use it for many sources
  /// of whose distances you keep little. Throws std::out_of_range.
  Eigen::MatrixXd once(std::span<const VertexIndex> sources) const;
  /// Distances from `source` (N).
  Eigen::VectorXd operator()(VertexIndex source) const;
  /// Distances from the nearest of `sources` (N), not kept. Throws std::out_of_range, and
  /// std::invalid_argument if there is no source.
  Eigen::VectorXd from_nearest(std::span<const VertexIndex> sources) const;

  const Weld& weld() const;

  /// Number of sources computed so far, without once() and from_nearest(). Kept sources are not
  /// computed again.
  int computed() const;
  /// Number of triangles without area, and vertices without triangles, as in HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace mimetra
