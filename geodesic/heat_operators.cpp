// CGAL's heat method takes 20 s to compile: no other file of the library sees it.

// CGAL's own point map for OpenMesh rounds what is written through it to float.
#define CGAL_USE_OM_POINTS

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

#include "geodesic/glued_surface.h"
#include "geodesic/heat_operators.h"

namespace mimetra::geodesic {
namespace {

struct DoublePoints : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoublePoints>;

/// Flips that CGAL may still make on this thread. Its flips never end where rounding decides anew
/// each time between equals, as in a regular polygon that is one flat face of a model.
thread_local std::size_t flips_left = 0;

/// More than this many flips per edge are no progress; the worst slivers need fewer than three.
constexpr std::size_t kFlipsPerEdge = 20;

/// What breaks such ties, as a share of the mean edge length: far above rounding, far below the
/// error of the heat method.
constexpr double kShake = 1e-8;

struct EndlessFlips : std::runtime_error {
  EndlessFlips()
      : std::runtime_error("intrinsic Delaunay flips do not end; use the mesh's own triangles") {}
};

/// CGAL's flips change the mesh through this function, which they find because it fits better than
/// CGAL's template: twice in each flip. It is the only way to stop them.
[[maybe_unused]] void set_face(Mesh::HalfedgeHandle halfedge, Mesh::FaceHandle face, Mesh& mesh) {
  if (flips_left == 0) throw EndlessFlips();
  --flips_left;
  mesh.set_face_handle(halfedge, face);
}

/// What CGAL's heat method asks of a geometry kernel (HeatMethodTraits_3), on OpenMesh's points.
// NOLINTBEGIN(readability-identifier-naming): CGAL's names
struct OpenMeshGeometry {
  using FT = double;
  using Point_3 = OpenMesh::Vec3d;
  using Vector_3 = OpenMesh::Vec3d;

  struct Construct_vector_3 {
    Vector_3 operator()(const Point_3& from, const Point_3& to) const { return to - from; }
  };
  struct Construct_sum_of_vectors_3 {
    Vector_3 operator()(const Vector_3& a, const Vector_3& b) const { return a + b; }
  };
  struct Construct_scaled_vector_3 {
    Vector_3 operator()(const Vector_3& a, double factor) const { return a * factor; }
  };
  struct Construct_cross_product_vector_3 {
    Vector_3 operator()(const Vector_3& a, const Vector_3& b) const { return a.cross(b); }
  };
  struct Compute_scalar_product_3 {
    double operator()(const Vector_3& a, const Vector_3& b) const { return a.dot(b); }
  };
  struct Compute_squared_length_3 {
    double operator()(const Vector_3& a) const { return a.sqrnorm(); }
  };
  struct Compute_squared_distance_3 {
    double operator()(const Point_3& a, const Point_3& b) const { return (b - a).sqrnorm(); }
  };

  Construct_vector_3 construct_vector_3_object() const { return {}; }
  Construct_sum_of_vectors_3 construct_sum_of_vectors_3_object() const { return {}; }
  Construct_scaled_vector_3 construct_scaled_vector_3_object() const { return {}; }
  Construct_cross_product_vector_3 construct_cross_product_vector_3_object() const { return {}; }
  Compute_scalar_product_3 compute_scalar_product_3_object() const { return {}; }
  Compute_squared_length_3 compute_squared_length_3_object() const { return {}; }
  Compute_squared_distance_3 compute_squared_distance_3_object() const { return {}; }
};
// NOLINTEND(readability-identifier-naming)

/// The matrices that CGAL hands to its solver while one of these is alive. CGAL makes the solver
/// itself and keeps it private, so they leave by a slot of the thread.
class CapturedMatrices {
 public:
  CapturedMatrices() { slot_ = this; }
  ~CapturedMatrices() { slot_ = nullptr; }
  CapturedMatrices(const CapturedMatrices&) = delete;
  CapturedMatrices& operator=(const CapturedMatrices&) = delete;

  static void add(const Eigen::SparseMatrix<double>& matrix) { slot_->matrices_.push_back(matrix); }
  /// In the order in which CGAL would factor them: mass + t L, then L.
  const std::vector<Eigen::SparseMatrix<double>>& matrices() const { return matrices_; }

 private:
  static thread_local CapturedMatrices* slot_;
  std::vector<Eigen::SparseMatrix<double>> matrices_;
};

thread_local CapturedMatrices* CapturedMatrices::slot_ = nullptr;

/// CGAL's SparseLinearAlgebraWithFactorTraits_d that keeps matrices and solves nothing.
struct CapturingAlgebra {
  /// CGAL's own matrix swaps a member that it has not set.
  class Matrix {
   public:
    Matrix() = default;
    Matrix(Eigen::Index rows, Eigen::Index columns) : matrix_(rows, columns) {
      // CGAL adds twelve entries for each triangle, of which a surface has two for each vertex.
      entries_.reserve(static_cast<std::size_t>(24 * rows));
    }

    void add_coef(Eigen::Index row, Eigen::Index column, double value) {
      entries_.emplace_back(row, column, value);
    }
    void set_coef(Eigen::Index row, Eigen::Index column, double value, bool /*is_new*/) {
      entries_.emplace_back(row, column, value);
    }
    void assemble_matrix() { matrix_.setFromTriplets(entries_.begin(), entries_.end()); }
    void swap(Matrix& other) { std::swap(*this, other); }
    const Eigen::SparseMatrix<double>& assembled() const { return matrix_; }

    friend Matrix operator*(double factor, Matrix matrix) {
      matrix.matrix_ *= factor;
      return matrix;
    }
    friend Matrix operator+(Matrix a, const Matrix& b) {
      a.matrix_ += b.matrix_;
      return a;
    }

   private:
    std::vector<Eigen::Triplet<double, Eigen::Index>> entries_;
    Eigen::SparseMatrix<double> matrix_;
  };
  using Vector = Eigen::VectorXd;
  using Index = Eigen::Index;

  bool factor(const Matrix& matrix, double& scale) {
    scale = 1;
    CapturedMatrices::add(matrix.assembled());
    return true;
  }
  /// CGAL's constructor already runs one query; any heat that has a gradient will do.
  bool linear_solver(const Matrix& heat, Vector& solution) {
    solution = Vector::LinSpaced(heat.assembled().rows(), 1, 2);
    return true;
  }
};

FlatTriangle flat_triangle(const OpenMesh::Vec3d& p0, const OpenMesh::Vec3d& p1,
                           const OpenMesh::Vec3d& p2) {
  const OpenMesh::Vec3d edge1 = p1 - p0, edge2 = p2 - p0;
  const double length = edge1.norm();
  const double along = edge1.dot(edge2) / length;
  const double height = edge1.cross(edge2).norm() / length;
  // Corners (0, 0), (length, 0), (along, height).
  return {{1 / length, -along / (length * height)}, {0, 1 / height}, length * height / 2};
}

const Mesh& halfedge_mesh(const Mesh& mesh) {
  return mesh;
}

using IntrinsicMesh =
    CGAL::Heat_method_3::Intrinsic_Delaunay_triangulation_3<Mesh, OpenMeshGeometry>;

const Mesh& halfedge_mesh(const IntrinsicMesh& mesh) {
  return mesh.triangle_mesh();
}

OpenMesh::Vec3d corner_position(const Mesh& mesh, Mesh::HalfedgeHandle halfedge) {
  return mesh.point(mesh.to_vertex_handle(halfedge));
}

/// In the triangle's own plane; the same vertex is elsewhere in another triangle.
OpenMesh::Vec3d corner_position(const IntrinsicMesh& mesh, Mesh::HalfedgeHandle halfedge) {
  return get(mesh.vertex_point_map(), target(halfedge, mesh));
}

/// `matrix` on the rows of its unknowns. Unknowns with the same row are one, which joins the sheets
/// of a surface that is not a manifold.
Eigen::SparseMatrix<double> joined(const Eigen::SparseMatrix<double>& matrix,
                                   const std::vector<VertexIndex>& row_of, Eigen::Index rows) {
  const bool joins_nothing = rows == matrix.rows() && std::ranges::is_sorted(row_of);
  if (joins_nothing) return matrix;
  Eigen::SparseMatrix<double> join(rows, matrix.rows());
  join.reserve(Eigen::VectorXi::Ones(join.cols()));
  for (Eigen::Index v = 0; v < join.cols(); ++v) join.insert(row_of[v], v) = 1;
  return join * matrix * join.transpose();
}

/// Matrices and triangles of `triangulation`, a model of FaceListGraph, on `row_of` (N) its
/// vertices.
template <typename Triangulation>
HeatOperators operators_on(const Triangulation& triangulation,
                           const std::vector<VertexIndex>& row_of, Eigen::Index rows) {
  using PointMap = typename boost::property_map<Triangulation, CGAL::vertex_point_t>::const_type;
  const CapturedMatrices captured;
  const CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<
      Triangulation, CGAL::Heat_method_3::Direct, PointMap, CapturingAlgebra, OpenMeshGeometry>
      heat_method(triangulation, get(CGAL::vertex_point, triangulation));

  HeatOperators operators;
  operators.heat = joined(captured.matrices().at(0), row_of, rows);
  operators.laplacian = joined(captured.matrices().at(1), row_of, rows);

  const Mesh& mesh = halfedge_mesh(triangulation);
  operators.triangles.resize(static_cast<Eigen::Index>(mesh.n_faces()), 3);
  operators.flat.reserve(mesh.n_faces());
  for (const auto face : mesh.faces()) {
    std::array<OpenMesh::Vec3d, 3> corners;
    auto halfedge = mesh.halfedge_handle(face);
    for (int corner = 0; corner < 3; ++corner) {
      operators.triangles(face.idx(), corner) = row_of[mesh.to_vertex_handle(halfedge).idx()];
      corners[corner] = corner_position(triangulation, halfedge);
      halfedge = mesh.next_halfedge_handle(halfedge);
    }
    operators.flat.push_back(flat_triangle(corners[0], corners[1], corners[2]));
  }
  return operators;
}

HeatOperators direct_operators(const GluedSurface& surface, const Positions& positions) {
  return operators_on(mesh_of<Mesh>(surface, positions), surface.vertex, positions.rows());
}

HeatOperators intrinsic_operators(const GluedSurface& surface, const Positions& positions) {
  const Mesh mesh = mesh_of<Mesh>(surface, positions);
  // CGAL copies the mesh first, which sets the face of each half-edge once: one flip per edge.
  flips_left = 2 * (kFlipsPerEdge + 1) * mesh.n_edges();
  const IntrinsicMesh intrinsic(mesh);
  // The copy numbers the vertices anew.
  std::vector<VertexIndex> row_of(surface.vertex.size());
  for (const auto& [copy, original] : intrinsic.v2v) {
    row_of[copy.idx()] = surface.vertex[original.idx()];
  }
  return operators_on(intrinsic, row_of, positions.rows());
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

/// Positions off their place by at most `distance` per coordinate, the same in every run.
Positions shaken(const Positions& positions, double distance) {
  std::mt19937 generator;
  const double middle = static_cast<double>(generator.max()) / 2;
  return positions.unaryExpr([&](double x) { return x + distance * (generator() / middle - 1); });
}

}  // namespace

HeatOperators heat_operators(const SurfaceComponent& component, bool intrinsic_delaunay) {
  const GluedSurface surface = glued(component.positions.rows(), component.triangles);
  if (!intrinsic_delaunay) return direct_operators(surface, component.positions);
  try {
    return intrinsic_operators(surface, component.positions);
  } catch (const EndlessFlips&) {
    // Vertices off their circle by more than rounding leave no equals to decide between.
    const double distance = kShake * mean_edge_length(component);
    return intrinsic_operators(surface, shaken(component.positions, distance));
  }
}

}  // namespace mimetra::geodesic
