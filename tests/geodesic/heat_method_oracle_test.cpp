// CGAL's own heat method, and what it hands to its solver; it takes 20 s to compile: no other test
// sees it.

// Its default solver.
#define CGAL_EIGEN3_ENABLED

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <gmock/gmock.h>

#include "geodesic/cgal_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "geodesic/heat_operators.h"
#include "tests/geodesic/surfaces.h"
#include "tests/mesh/captured_performance.h"
#include "tests/shared_data.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/weld.h"

namespace mimetra::geodesic {
namespace {

using test::Shape;
using Matrix = Eigen::SparseMatrix<double>;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

/// What CGAL factors, in its order: mass + t L, then L.
std::vector<Matrix>& factored() {
  static std::vector<Matrix> matrices;
  return matrices;
}

/// CGAL's SparseLinearAlgebraWithFactorTraits_d, which keeps matrices and solves nothing.
struct Listener {
  class Matrix {
   public:
    Matrix() = default;
    Matrix(Eigen::Index rows, Eigen::Index columns) : matrix_(rows, columns) {}

    void add_coef(Eigen::Index row, Eigen::Index column, double value) {
      entries_.emplace_back(row, column, value);
    }
    void set_coef(Eigen::Index row, Eigen::Index column, double value, bool /*is_new*/) {
      entries_.emplace_back(row, column, value);
    }
    void assemble_matrix() { matrix_.setFromTriplets(entries_.begin(), entries_.end()); }
    void swap(Matrix& other) { std::swap(*this, other); }
    const geodesic::Matrix& assembled() const { return matrix_; }

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
    geodesic::Matrix matrix_;
  };
  using Vector = Eigen::VectorXd;
  using Index = Eigen::Index;

  bool factor(const Matrix& matrix, double& scale) {
    scale = 1;
    factored().push_back(matrix.assembled());
    return true;
  }
  /// CGAL's constructor already runs one query; any heat that has a gradient will do.
  bool linear_solver(const Matrix& heat, Vector& solution) {
    solution = Vector::LinSpaced(heat.assembled().rows(), 1, 2);
    return true;
  }
};

Mesh mesh_of(const SurfaceComponent& component) {
  Mesh mesh;
  for (const auto p : component.positions.rowwise()) mesh.add_vertex(Point(p[0], p[1], p[2]));
  const auto vertex = [](int v) { return Mesh::Vertex_index(static_cast<unsigned>(v)); };
  for (const auto t : component.triangles.rowwise()) {
    // CGAL begins at the first corner, and half-edges of Surface lead to the second.
    mesh.add_face(vertex(t[1]), vertex(t[2]), vertex(t[0]));
  }
  return mesh;
}

template <typename Mode>
Eigen::VectorXd distances_of_cgal(const SurfaceComponent& component, VertexIndex source) {
  Mesh mesh = mesh_of(component);
  const auto result = mesh.add_property_map<Mesh::Vertex_index, double>("v:distance", 0).first;
  CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh, Mode> heat_method(mesh);
  heat_method.add_source(Mesh::Vertex_index(static_cast<unsigned>(source)));
  heat_method.estimate_geodesic_distances(result);
  Eigen::VectorXd distances(component.positions.rows());
  for (const auto v : mesh.vertices()) distances[v.idx()] = result[v];
  return distances;
}

/// Mass + t L, and L.
template <typename Mode>
std::vector<Matrix> matrices_of_cgal(const SurfaceComponent& component) {
  constexpr bool kIntrinsic = std::is_same_v<Mode, CGAL::Heat_method_3::Intrinsic_Delaunay>;
  factored().clear();
  const Mesh mesh = mesh_of(component);
  const CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh, Mode, CGAL::Default, Listener>
      heat_method(mesh);
  std::vector<Matrix> matrices = factored();
  if constexpr (kIntrinsic) {
    // CGAL's copy of the mesh numbers the vertices anew.
    Eigen::PermutationMatrix<Eigen::Dynamic> original(component.positions.rows());
    for (const auto& [copy, vertex] : heat_method.m_idt.v2v) {
      original.indices()[copy.idx()] = static_cast<int>(vertex.idx());
    }
    for (Matrix& matrix : matrices) matrix = original * matrix * original.transpose();
  }
  return matrices;
}

/// Largest difference of an entry, as a share of the largest.
double difference(const Matrix& actual, const Matrix& expected) {
  const Matrix left = actual - expected;
  const auto largest = [](const Matrix& matrix) {
    return Eigen::Map<const Eigen::VectorXd>(matrix.valuePtr(), matrix.nonZeros())
        .cwiseAbs()
        .maxCoeff();
  };
  return largest(left) / largest(expected);
}

template <typename Mode>
void expect_matrices_of_cgal(const Shape& shape, double rounding) {
  constexpr bool kIntrinsic = std::is_same_v<Mode, CGAL::Heat_method_3::Intrinsic_Delaunay>;
  const SurfaceComponents parts(shape.positions, shape.triangles, Degenerate::left_out);
  for (const SurfaceComponent& component : parts.components) {
    const std::vector<Matrix> expected = matrices_of_cgal<Mode>(component);
    ASSERT_EQ(expected.size(), 2u);
    const HeatOperators operators = heat_operators(component, kIntrinsic);
    EXPECT_LE(difference(operators.heat, expected[0]), rounding);
    EXPECT_LE(difference(operators.laplacian, expected[1]), rounding);
  }
}

/// A bumpy sheet: it has a border.
Shape sheet() {
  Shape shape = test::grid(30, 20);
  for (auto p : shape.positions.rowwise()) p[2] = std::sin(0.7 * p[0] + 1) + std::cos(0.5 * p[1]);
  return shape;
}

/// A captured face, welded; without shapes where it is missing.
std::vector<Shape> captured_faces() {
  const auto path = test::shared_path("data/facecap/neutral.obj");
  if (path.empty()) return {};
  const TriMesh mesh = test::read_plain_obj(path);
  return {{mesh.positions, Weld::exact(mesh.positions).welded(mesh.connectivity.triangles)}};
}

std::vector<Shape> shapes() {
  std::vector<Shape> all = captured_faces();
  all.push_back(test::bumpy_sphere(4));
  all.push_back(sheet());
  return all;
}

TEST(HeatOperators, AreThoseOfCgalOnTheMeshAsIs) {
  for (const Shape& shape : shapes()) {
    expect_matrices_of_cgal<CGAL::Heat_method_3::Direct>(shape, 1e-15);
  }
}

TEST(HeatOperators, AreThoseOfCgalOnTheIntrinsicDelaunayTriangulation) {
  for (const Shape& shape : shapes()) {
    // Flips come in another order, and the lengths of edges that are flipped again round otherwise.
    expect_matrices_of_cgal<CGAL::Heat_method_3::Intrinsic_Delaunay>(shape, 4e-15);
  }
}

/// CGAL runs on its own mesh class. The difference is rounding: 1e-16 times the condition numbers
/// of the heat step and of the Poisson system, each below 1e4 for some thousand triangles.
TEST(HeatGeodesics, AreThoseOfCgalOnItsOwnMesh) {
  constexpr double kConditions = 1e-9;
  for (const Shape& shape : {test::bumpy_sphere(4), sheet()}) {
    const SurfaceComponents parts(shape.positions, shape.triangles, Degenerate::refused);
    const SurfaceComponent& component = parts.components.at(0);
    const HeatGeodesics intrinsic(shape.positions, shape.triangles);
    const HeatGeodesics direct(shape.positions, shape.triangles, {.intrinsic_delaunay = false});
    for (const VertexIndex source : {0, 17, 400}) {
      using CGAL::Heat_method_3::Direct;
      using CGAL::Heat_method_3::Intrinsic_Delaunay;
      EXPECT_LT(test::relative_error(intrinsic.distances(source),
                                     distances_of_cgal<Intrinsic_Delaunay>(component, source)),
                kConditions);
      EXPECT_LT(test::relative_error(direct.distances(source),
                                     distances_of_cgal<Direct>(component, source)),
                kConditions);
    }
  }
}

TEST(CgalGeodesics, AreTheHeatDistances) {
  for (const Shape& shape : shapes()) {
    const HeatGeodesics heat(shape.positions, shape.triangles);
    const CgalGeodesics cgal(shape.positions, shape.triangles);
    for (const VertexIndex source : {0, 17, 400}) {
      const Eigen::VectorXd expected = cgal.distances(source);
      const Eigen::VectorXd found = heat.distances(source);
      double farthest = 0, apart = 0;
      for (Eigen::Index v = 0; v < expected.size(); ++v) {
        ASSERT_EQ(std::isfinite(found[v]), std::isfinite(expected[v]));
        if (!std::isfinite(expected[v])) continue;
        farthest = std::max(farthest, expected[v]);
        apart = std::max(apart, std::abs(found[v] - expected[v]));
      }
      EXPECT_LE(apart, 1e-12 * farthest);
    }
  }
}

TEST(CgalGeodesics, AreTheHeatDistancesFromTheNearestOfSeveral) {
  const Shape shape = test::bumpy_sphere(4);
  const std::vector<VertexIndex> sources = {5, 77, 600};
  EXPECT_LE(
      test::relative_error(HeatGeodesics(shape.positions, shape.triangles).distances(sources),
                           CgalGeodesics(shape.positions, shape.triangles).distances(sources)),
      1e-12);
}

TEST(CgalGeodesics, NameAVertexWhereSheetsMeet) {
  const Shape shape = test::both(test::grid(2, 2), test::touching_squares(3));
  EXPECT_THAT([&] { CgalGeodesics(shape.positions, shape.triangles); },
              testing::ThrowsMessage<MismatchError>(testing::HasSubstr("meet at vertex 12, ")));
}

TEST(CgalGeodesics, SayWhereHeatFadesOnTheWay) {
  const Shape strip = test::grid(1200, 3);
  const CgalGeodesics cgal(strip.positions, strip.triangles);
  EXPECT_THAT([&] { cgal.distances(0); }, testing::ThrowsMessage<MismatchError>(
                                              testing::HasSubstr("heat from vertex 0 fades")));
}

}  // namespace
}  // namespace mimetra::geodesic
