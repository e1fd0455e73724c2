// CGAL's heat method takes 20 s to compile, so no other file of the library includes it.

// Select CGAL's default solver.
#define CGAL_EIGEN3_ENABLED

#include <array>
#include <limits>
#include <mutex>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

#include "geodesic/cgal_geodesics.h"
#include "geodesic/heat_operators.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/surface.h"

namespace mimetra::geodesic {
namespace {

struct DoublePoints : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoublePoints>;

/// Positions of a mesh for CGAL. CGAL's own property map for OpenMesh rounds written values to
/// float.
struct PointMap {
  using key_type = Mesh::VertexHandle;
  using value_type = CGAL::Simple_cartesian<double>::Point_3;
  using reference = value_type;
  using category = boost::read_write_property_map_tag;

  friend value_type get(const PointMap& map, key_type vertex) {
    const Mesh::Point& point = map.mesh->point(vertex);
    return {point[0], point[1], point[2]};
  }
  friend void put(const PointMap& map, key_type vertex, const value_type& point) {
    map.mesh->set_point(vertex, {point.x(), point.y(), point.z()});
  }

  Mesh* mesh;
};

[[maybe_unused]] PointMap get(boost::vertex_point_t, const Mesh& mesh) {
  return {const_cast<Mesh*>(&mesh)};  // as in CGAL's own maps, one type reads and writes
}

}  // namespace
}  // namespace mimetra::geodesic

template <>
struct boost::property_map<mimetra::geodesic::Mesh, boost::vertex_point_t> {
  using type = mimetra::geodesic::PointMap;
  using const_type = type;
};

namespace mimetra::geodesic {
namespace {

/// Flips that CGAL may still make on this thread. CGAL flips forever if rounding keeps changing the
/// choice between equals, as in a regular polygon that is one flat face of a model.
thread_local std::size_t flips_left = 0;

/// Number of flips per edge beyond which they no longer progress; the worst slivers need fewer than
/// three.
constexpr std::size_t kFlipsPerEdge = 20;

/// Displacement that breaks such ties, as a share of the mean edge length. It is far above rounding
/// and far below the error of the heat method.
constexpr double kShake = 1e-8;

struct EndlessFlips : std::runtime_error {
  EndlessFlips()
      : std::runtime_error("intrinsic Delaunay flips do not end; use the mesh's own triangles") {}
};

/// Limits CGAL's flips, which change the mesh through this function, twice per flip. Overload
/// resolution prefers it to CGAL's template. There is no other way to stop the flips.
[[maybe_unused]] void set_face(Mesh::HalfedgeHandle halfedge, Mesh::FaceHandle face, Mesh& mesh) {
  if (flips_left == 0) throw EndlessFlips();
  --flips_left;
  mesh.set_face_handle(halfedge, face);
}

Mesh mesh_of(const Surface& surface, const Positions& positions) {
  Mesh mesh;
  mesh.PolyConnectivity::assign_connectivity(surface.half_edges());
  for (const auto vertex : mesh.vertices()) {
    const auto row = positions.row(surface.vertex_of(vertex));
    mesh.set_point(vertex, {row[0], row[1], row[2]});
  }
  return mesh;
}

double mean_edge_length(const SurfaceComponent& component) {
  double sum = 0;
  for (Eigen::Index t = 0; t < component.triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      sum += (component.positions.row(component.triangles(t, corner)) -
              component.positions.row(component.triangles(t, (corner + 1) % 3)))
                 .norm();
    }
  }
  return sum / static_cast<double>(component.triangles.size());
}

/// Positions displaced by at most `distance` per coordinate, the same in every run.
Positions shaken(const Positions& positions, double distance) {
  std::mt19937 generator;
  const double middle = static_cast<double>(generator.max()) / 2;
  return positions.unaryExpr([&](double x) { return x + distance * (generator() / middle - 1); });
}

/// Result of `use` on the component's mesh. If its flips do not end, the result on a mesh with
/// displaced vertices, which no longer has equals to decide between.
template <typename Use>
auto with_flips(const SurfaceComponent& component, const Surface& surface, const Use& use) {
  // CGAL first copies the mesh, which sets the face of each half-edge once, like one flip per edge.
  const std::size_t most = 2 * (kFlipsPerEdge + 1) * surface.half_edges().n_edges();
  try {
    flips_left = most;
    return use(mesh_of(surface, component.positions));
  } catch (const EndlessFlips&) {
    flips_left = most;
    const double distance = kShake * mean_edge_length(component);
    return use(mesh_of(surface, shaken(component.positions, distance)));
  }
}

using Corners = std::array<OpenMesh::Vec3d, 3>;

FlatTriangle flat_triangle(const Corners& p) {
  const OpenMesh::Vec3d edge1 = p[1] - p[0], edge2 = p[2] - p[0];
  const double length = edge1.norm();
  const double along = edge1.dot(edge2) / length;
  const double height = edge1.cross(edge2).norm() / length;
  // Corners (0, 0), (length, 0), (along, height).
  return {{1 / length, -along / (length * height)}, {0, 1 / height}, length * height / 2};
}

/// Cotangent of the angle at `corner`; 0 without area.
double cotangent(const Corners& p, int corner) {
  const auto at = [&p](int c) -> const OpenMesh::Vec3d& { return p[std::size_t(c % 3)]; };
  const OpenMesh::Vec3d one = at(corner + 1) - at(corner), other = at(corner + 2) - at(corner);
  const double sine = one.cross(other).norm();
  return sine != 0 ? one.dot(other) / sine : 0;
}

/// Entries of mass and Laplacian, added triangle by triangle.
class OperatorSum {
 public:
  OperatorSum(Eigen::Index rows, std::size_t triangles) : rows_(rows) {
    mass_.reserve(3 * triangles);
    laplacian_.reserve(15 * triangles);
  }

  void add(const std::array<VertexIndex, 3>& row, const Corners& p) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = row[std::size_t((c + 1) % 3)], b = row[std::size_t((c + 2) % 3)];
      const double half = cotangent(p, c) / 2;
      laplacian_.emplace_back(a, b, -half);
      laplacian_.emplace_back(b, a, -half);
      laplacian_.emplace_back(a, a, half);
      laplacian_.emplace_back(b, b, half);
    }
    const double sixth = (1.0 / 6) * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    for (const VertexIndex v : row) {
      mass_.emplace_back(v, v, sixth);
      // CGAL's term for each corner. Without it L would be singular, as it maps constants to 0.
      constexpr double kOfCorner = 1e-8;
      laplacian_.emplace_back(v, v, kOfCorner);
    }
  }

  Eigen::SparseMatrix<double> mass() const { return matrix(mass_); }
  Eigen::SparseMatrix<double> laplacian() const { return matrix(laplacian_); }

 private:
  using Entries = std::vector<Eigen::Triplet<double>>;

  Eigen::SparseMatrix<double> matrix(const Entries& entries) const {
    Eigen::SparseMatrix<double> matrix(rows_, rows_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  Eigen::Index rows_;
  Entries mass_, laplacian_;
};

/// Operators on the faces of `mesh`. Vertices with equal rows count as one, which joins the sheets
/// of a surface that is not a manifold. `position` returns the corner that a half-edge points to.
template <typename RowOf, typename PositionOf>
HeatOperators operators_on(const Mesh& mesh, Eigen::Index rows, const RowOf& row_of,
                           const PositionOf& position) {
  HeatOperators operators;
  operators.triangles.resize(static_cast<Eigen::Index>(mesh.n_faces()), 3);
  operators.flat.reserve(mesh.n_faces());
  OperatorSum sum(rows, mesh.n_faces());
  double edges = 0;
  for (const auto face : mesh.faces()) {
    std::array<VertexIndex, 3> row;
    std::array<double, 3> share;  // share of this face in the edge before each corner
    Corners corners;
    auto halfedge = mesh.halfedge_handle(face);
    for (std::size_t c = 0; c < 3; ++c) {
      row[c] = row_of(mesh.to_vertex_handle(halfedge));
      share[c] = mesh.is_boundary(mesh.opposite_halfedge_handle(halfedge)) ? 1 : 0.5;
      corners[c] = position(halfedge);
      halfedge = mesh.next_halfedge_handle(halfedge);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      edges += share[c] * (corners[(c + 2) % 3] - corners[c]).norm();
      operators.triangles(face.idx(), static_cast<Eigen::Index>(c)) = row[c];
    }
    sum.add(row, corners);
    operators.flat.push_back(flat_triangle(corners));
  }
  const double mean = 1.0 / static_cast<double>(mesh.n_edges()) * edges;
  operators.laplacian = sum.laplacian();
  operators.heat = sum.mass() + mean * mean * operators.laplacian;
  return operators;
}

HeatOperators direct_operators(const Surface& surface, const Positions& positions) {
  const Mesh mesh = mesh_of(surface, positions);
  return operators_on(
      mesh, positions.rows(), [&](auto vertex) { return surface.vertex_of(vertex); },
      [&](auto halfedge) { return mesh.point(mesh.to_vertex_handle(halfedge)); });
}

using Intrinsic =
    CGAL::Heat_method_3::Intrinsic_Delaunay_triangulation_3<Mesh, CGAL::Simple_cartesian<double>>;

HeatOperators intrinsic_operators(const Surface& surface, const Mesh& mesh, Eigen::Index rows) {
  const Intrinsic intrinsic(mesh);
  // CGAL's copy renumbers the vertices.
  std::vector<VertexIndex> row_of(mesh.n_vertices());
  for (const auto& [copy, original] : intrinsic.v2v) {
    row_of[static_cast<std::size_t>(copy.idx())] = surface.vertex_of(original);
  }
  return operators_on(
      intrinsic.triangle_mesh(), rows,
      [&](auto vertex) { return row_of[static_cast<std::size_t>(vertex.idx())]; },
      [&](auto halfedge) {
        // In the triangle's own plane; each triangle has its own coordinates for a vertex.
        const auto& [x, y] = get(intrinsic.hcmap(), halfedge);
        return OpenMesh::Vec3d(x, y, 0);
      });
}

Surface surface_of(const SurfaceComponent& component) {
  return {static_cast<int>(component.positions.rows()), component.triangles};
}

/// CGAL's heat method on one component. Vertices are rows of the component.
class CgalComponent {
 public:
  explicit CgalComponent(SurfaceComponent component)
      : component_(std::move(component)), surface_(surface_of(component_)) {
    if (surface_.copies() == 0) return;
    const VertexIndex several = surface_.vertex_of(Mesh::VertexHandle(surface_.vertices()));
    throw MismatchError("sheets of the surface meet at vertex " +
                        std::to_string(component_.vertices[several]) +
                        ", and CGAL's heat method takes manifolds only; use distances by heat");
  }

  /// Distance from the nearest of `sources` (N). \pre at least one source
  Eigen::VectorXd distances(const std::vector<VertexIndex>& sources) const {
    std::unique_ptr<Query> query = idle_query();
    Eigen::VectorXd result = query->distances(sources);
    {
      const std::lock_guard lock(mutex_);
      idle_.push_back(std::move(query));
    }
    // CGAL starts from the largest double and compares it with values that may be NaN.
    if (!(result.maxCoeff() < std::numeric_limits<double>::max())) {
      throw MismatchError("the heat from vertex " +
                          std::to_string(component_.vertices[sources.front()]) +
                          " fades before it has reached all of its component, as after some 700 "
                          "edges; use distances by heat");
    }
    return result;
  }

 private:
  /// CGAL's object, which holds the state of a query.
  class Query {
   public:
    explicit Query(Mesh mesh) : mesh_(std::move(mesh)), heat_method_(mesh_) {}

    Eigen::VectorXd distances(const std::vector<VertexIndex>& sources) {
      heat_method_.clear_sources();
      for (const VertexIndex source : sources) heat_method_.add_source(Mesh::VertexHandle(source));
      Eigen::VectorXd result(static_cast<Eigen::Index>(mesh_.n_vertices()));
      heat_method_.estimate_geodesic_distances(DistanceMap{&result});
      return result;
    }

   private:
    struct DistanceMap {
      using key_type = Mesh::VertexHandle;
      using value_type = double;
      using reference = double;
      using category = boost::writable_property_map_tag;

      friend void put(const DistanceMap& map, key_type vertex, double distance) {
        (*map.distances)[vertex.idx()] = distance;
      }

      Eigen::VectorXd* distances;
    };

    Mesh mesh_;
    CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh,
                                                           CGAL::Heat_method_3::Intrinsic_Delaunay>
        heat_method_;
  };

  std::unique_ptr<Query> idle_query() const {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Query> query = std::move(idle_.back());
        idle_.pop_back();
        return query;
      }
    }
    return with_flips(component_, surface_,
                      [](Mesh mesh) { return std::make_unique<Query>(std::move(mesh)); });
  }

  SurfaceComponent component_;
  Surface surface_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Query>> idle_;
};

}  // namespace

HeatOperators heat_operators(const SurfaceComponent& component, bool intrinsic_delaunay) {
  const Surface surface = surface_of(component);
  if (!intrinsic_delaunay) return direct_operators(surface, component.positions);
  return with_flips(component, surface, [&](const Mesh& mesh) {
    return intrinsic_operators(surface, mesh, component.positions.rows());
  });
}

class CgalGeodesics::Implementation {
 public:
  Implementation(const Positions& positions, const Triangles& triangles)
      : components_(positions, triangles, Degenerate::left_out) {
    for (SurfaceComponent& component : components_.components) {
      const std::vector<VertexIndex> vertices = component.vertices;
      methods_.push_back(std::make_unique<CgalComponent>(std::move(component)));
      component.vertices = vertices;  // queries need the numbering
    }
  }

  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const {
    return components_.distances(
        sources, [this](std::size_t c, const auto& rows) { return methods_[c]->distances(rows); });
  }

  const SurfaceComponents& components() const { return components_; }

 private:
  SurfaceComponents components_;
  std::vector<std::unique_ptr<CgalComponent>> methods_;
};

CgalGeodesics::CgalGeodesics(const Positions& positions, const Triangles& triangles)
    : implementation_(std::make_unique<Implementation>(positions, triangles)) {}

CgalGeodesics::~CgalGeodesics() = default;
CgalGeodesics::CgalGeodesics(CgalGeodesics&&) noexcept = default;
CgalGeodesics& CgalGeodesics::operator=(CgalGeodesics&&) noexcept = default;

Eigen::VectorXd CgalGeodesics::distances(std::span<const VertexIndex> sources) const {
  return implementation_->distances(sources);
}

Eigen::VectorXd CgalGeodesics::distances(VertexIndex source) const {
  return distances(std::span(&source, 1));
}

int CgalGeodesics::degenerate_triangles() const {
  return implementation_->components().degenerate_triangles;
}

const std::vector<VertexIndex>& CgalGeodesics::vertices_without_face() const {
  return implementation_->components().vertices_without_face;
}

}  // namespace mimetra::geodesic
