#include "geodesic/exact_geodesics.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh_shortest_path.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

#include "geodesic/surface_components.h"
#include "toolkit/mesh/surface.h"

namespace mimetra::geodesic {
namespace {

constexpr double kUnreachable = std::numeric_limits<double>::infinity();

struct DoublePoints : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoublePoints>;
using ShortestPath = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<
    CGAL::Exact_predicates_inexact_constructions_kernel, Mesh>>;

/// Exact distances on one connected component. Vertices are rows of the component.
class ExactComponent {
 public:
  explicit ExactComponent(const SurfaceComponent& component);

  /// Distance from the nearest of `sources` (N). \pre At least one source.
  Eigen::VectorXd distances(const std::vector<VertexIndex>& sources) const;

 private:
  Eigen::VectorXd distances_within_sheets(const std::vector<VertexIndex>& sources) const;

  Surface surface_;
  Mesh mesh_;
};

/// First triangle with each set of three corners. A second one shortens no path, but would make all
/// three vertices passages between sheets.
Triangles without_doubles(const Triangles& triangles) {
  std::vector<Eigen::Index> kept;
  std::set<std::array<VertexIndex, 3>> known;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    std::array<VertexIndex, 3> corners = {triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::ranges::sort(corners);
    if (known.insert(corners).second) kept.push_back(t);
  }
  return triangles(kept, Eigen::all);
}

ExactComponent::ExactComponent(const SurfaceComponent& component)
    : surface_(static_cast<int>(component.positions.rows()), without_doubles(component.triangles)) {
  mesh_.PolyConnectivity::assign_connectivity(surface_.half_edges());
  for (const auto vertex : mesh_.vertices()) {
    const auto row = component.positions.row(surface_.vertex_of(vertex));
    mesh_.set_point(vertex, {row[0], row[1], row[2]});
  }
}

/// Dijkstra's algorithm over the vertices where sheets touch; each passes its distance to all its
/// sheets.
Eigen::VectorXd ExactComponent::distances(const std::vector<VertexIndex>& sources) const {
  Eigen::VectorXd best = distances_within_sheets(sources);
  std::vector<VertexIndex> passages;
  for (VertexIndex row = 0; row < best.size(); ++row) {
    if (surface_.copies_of(row).size() > 1) passages.push_back(row);
  }
  while (!passages.empty()) {
    const auto nearest =
        std::min_element(passages.begin(), passages.end(),
                         [&best](VertexIndex a, VertexIndex b) { return best[a] < best[b]; });
    const VertexIndex passage = *nearest;
    passages.erase(nearest);
    best =
        best.cwiseMin((distances_within_sheets({passage}).array() + best[passage]).matrix().eval());
  }
  return best;
}

Eigen::VectorXd ExactComponent::distances_within_sheets(
    const std::vector<VertexIndex>& sources) const {
  // CGAL's object holds the state of a query, so each query makes its own.
  ShortestPath shortest_path(mesh_);
  for (const VertexIndex source : sources) {
    for (const auto copy : surface_.copies_of(source)) shortest_path.add_source_point(copy);
  }
  Eigen::VectorXd result = Eigen::VectorXd::Constant(surface_.vertices(), kUnreachable);
  for (const auto vertex : mesh_.vertices()) {
    const double distance = shortest_path.shortest_distance_to_source_points(vertex).first;
    double& known = result[surface_.vertex_of(vertex)];
    // CGAL returns -1 if no source reaches the vertex.
    if (distance >= 0) known = std::min(known, distance);
  }
  return result;
}

}  // namespace

class ExactGeodesics::Implementation {
 public:
  Implementation(const Positions& positions, const Triangles& triangles)
      : surface_(positions, triangles, Degenerate::left_out) {
    for (const SurfaceComponent& component : surface_.components) {
      components_.emplace_back(component);
    }
  }

  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const {
    return surface_.distances(sources, [this](std::size_t c, const auto& rows) {
      return components_[c].distances(rows);
    });
  }

  const SurfaceComponents& surface() const { return surface_; }

 private:
  SurfaceComponents surface_;
  std::vector<ExactComponent> components_;
};

ExactGeodesics::ExactGeodesics(const Positions& positions, const Triangles& triangles)
    : implementation_(std::make_unique<Implementation>(positions, triangles)) {}

ExactGeodesics::~ExactGeodesics() = default;
ExactGeodesics::ExactGeodesics(ExactGeodesics&&) noexcept = default;
ExactGeodesics& ExactGeodesics::operator=(ExactGeodesics&&) noexcept = default;

Eigen::VectorXd ExactGeodesics::distances(VertexIndex source) const {
  return distances(std::span(&source, 1));
}

Eigen::VectorXd ExactGeodesics::distances(std::span<const VertexIndex> sources) const {
  return implementation_->distances(sources);
}

int ExactGeodesics::degenerate_triangles() const {
  return implementation_->surface().degenerate_triangles;
}

const std::vector<VertexIndex>& ExactGeodesics::vertices_without_face() const {
  return implementation_->surface().vertices_without_face;
}

}  // namespace mimetra::geodesic
