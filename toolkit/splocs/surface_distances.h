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

/// Distances from each of some vertices (S) to all vertices, N x S, +infinity where there is no
/// way. What the decomposition and the regions ask for.
using DistanceFunction = std::function<Eigen::MatrixXd(std::span<const VertexIndex>)>;

/// Asks `distances` (N) for one vertex after the other, from the calling thread.
DistanceFunction one_by_one(std::function<Eigen::VectorXd(VertexIndex)> distances);

enum class GeodesicMethod {
  heat,         ///< HeatGeodesics
  heat_direct,  ///< the same on the mesh's own triangles
  exact,        ///< ExactGeodesics
  cgal          ///< CgalGeodesics
};

/// As people choose it.
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

/// Distances along a surface whose coinciding vertices are welded, so that they pass across UV
/// seams. Those asked for last are kept; copies share what they know.
class SurfaceDistances {
 public:
  /// What is kept at most, in bytes: all sources of a face, 61 of a million vertices.
  static constexpr std::size_t kKeptBytes = std::size_t{1} << 29;

  /// Keeps no reference to the mesh. Queries take as many threads as the context has; nothing else
  /// of it is kept. Throws std::invalid_argument as HeatGeodesics does.
  SurfaceDistances(const Positions& positions, const Triangles& triangles, const Weld& weld,
                   GeodesicMethod method = GeodesicMethod::heat, const Context& context = {})
      : SurfaceDistances(positions, triangles, weld, method, kKeptBytes, context) {}
  SurfaceDistances(const Positions& positions, const Triangles& triangles, const Weld& weld,
                   GeodesicMethod method, std::size_t kept_bytes, const Context& context = {});

  /// Distances from each of `sources` (N x S). What is not known yet is computed for several of
  /// them at once. Safe to call from several threads. Throws std::out_of_range.
  Eigen::MatrixXd operator()(std::span<const VertexIndex> sources) const;
  /// The same, computed anew and not kept: for who asks for many and keeps less of each.
  Eigen::MatrixXd once(std::span<const VertexIndex> sources) const;
  /// Distances from `source` (N).
  Eigen::VectorXd operator()(VertexIndex source) const;
  /// Distances from the nearest of `sources` (N), not kept. Throws std::out_of_range, and
  /// std::invalid_argument when there is no source.
  Eigen::VectorXd from_nearest(std::span<const VertexIndex> sources) const;

  /// Which vertices are one.
  const Weld& weld() const;

  /// Sources computed so far, but for once() and from_nearest(): one that is kept is not computed
  /// again.
  int computed() const;
  /// As HeatGeodesics.
  int degenerate_triangles() const;
  const std::vector<VertexIndex>& vertices_without_face() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace mimetra
