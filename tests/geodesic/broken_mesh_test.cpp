#include <limits>

#include <gmock/gmock.h>

#include "geodesic/exact_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "tests/geodesic/surfaces.h"

namespace mimetra::geodesic {
namespace {

using test::heat_on;
using test::mean_error;
using test::relative_error;
using test::Shape;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
Shape with_triangle(Shape shape, int a, int b, int c) {
  shape.triangles.conservativeResize(shape.triangles.rows() + 1, 3);
  shape.triangles.bottomRows(1) << a, b, c;
  return shape;
}

Shape with_vertex(Shape shape, double x, double y, double z) {
  shape.positions.conservativeResize(shape.positions.rows() + 1, 3);
  shape.positions.bottomRows(1) << x, y, z;
  return shape;
}

/// A grid with one more triangle that has no area, of each kind.
std::vector<Shape> degenerate_shapes() {
  const Shape grid = test::grid(6, 5);
  const Shape collinear = with_triangle(grid, 0, 1, 2);
  const Shape repeated = with_triangle(grid, 7, 7, 9);
  const Shape doubled = with_triangle(with_vertex(grid, 0, 0, 0), 0, 30, 1);
  const Shape needle = with_triangle(with_vertex(grid, 0.5, -1e-7, 0), 0, 30, 1);
  return {collinear, repeated, doubled, needle};
}

TEST(DegenerateTriangles, AreLeftOutAndCounted) {
  for (const bool intrinsic : {true, false}) {
    const HeatOptions options{.intrinsic_delaunay = intrinsic};
    const Eigen::VectorXd whole = heat_on(test::grid(6, 5), options).distances(3);
    for (const Shape& shape : degenerate_shapes()) {
      const HeatGeodesics heat = heat_on(shape, options);
      EXPECT_EQ(heat.degenerate_triangles(), 1);
      EXPECT_EQ(heat.distances(3).head(30), whole);
    }
  }
}

TEST(DegenerateTriangles, AreRefusedByNameOnRequest) {
  const auto shapes = degenerate_shapes();
  const char* reasons[] = {"(vertices 0, 1, 2) has no area", "(vertices 7, 7, 9) repeats a vertex",
                           "", ""};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_THAT([&] { heat_on(shapes[i], {.skip_degenerate = false}); },
                ThrowsMessage<std::invalid_argument>(AllOf(
                    HasSubstr("triangle 40"), HasSubstr(reasons[i]), HasSubstr("remove it"))));
  }
}

TEST(DegenerateTriangles, AreNotThinOnes) {
  // Quality 2 A / l_max^2 of about 1e-5, ten times the limit.
  const Shape needle = with_triangle(with_vertex(test::grid(6, 5), 0.5, -1e-5, 0), 0, 30, 1);
  const HeatGeodesics heat = heat_on(needle);
  EXPECT_EQ(heat.degenerate_triangles(), 0);
  const Eigen::VectorXd distances = heat.distances(3);
  EXPECT_TRUE(distances.allFinite());
  // The vertex lies on an edge but for 1e-5, and so does its distance.
  EXPECT_GT(distances[30], distances[1]);
  EXPECT_LT(distances[30], distances[0]);
}

TEST(DegenerateTriangles, AreLeftOutOfExactDistances) {
  const Shape grid = test::grid(6, 5);
  const Eigen::VectorXd expected = test::euclidean(grid.positions, 3);
  for (const Shape& shape : degenerate_shapes()) {
    const ExactGeodesics exact(shape.positions, shape.triangles);
    EXPECT_EQ(exact.degenerate_triangles(), 1);
    EXPECT_LT(relative_error(exact.distances(3).head(30), expected), test::kHeatRounding);
  }
}

TEST(VerticesWithoutFace, AreNamedAndAtInfinity) {
  // Vertex 6 is alone, vertices 7 and 8 have only a triangle without area.
  Shape shape = test::octahedron();
  for (const double x : {5, 6, 7}) shape = with_vertex(shape, x, 0, 0);
  shape = with_triangle(shape, 0, 7, 8);
  const HeatGeodesics heat = heat_on(shape);
  const ExactGeodesics exact(shape.positions, shape.triangles);
  EXPECT_THAT(heat.vertices_without_face(), ElementsAre(6, 7, 8));
  EXPECT_THAT(exact.vertices_without_face(), ElementsAre(6, 7, 8));
  for (const Eigen::VectorXd& distances : {heat.distances(0), exact.distances(0)}) {
    EXPECT_TRUE(distances.head(6).allFinite());
    EXPECT_EQ(distances.tail(3), Eigen::Vector3d::Constant(kInfinity));
  }
}

TEST(VerticesWithoutFace, ReachNothing) {
  const Shape shape = with_vertex(test::octahedron(), 5, 0, 0);
  EXPECT_EQ(heat_on(shape).distances(6), Eigen::VectorXd::Constant(7, kInfinity));
  const HeatGeodesics without(Positions::Zero(2, 3), Triangles(0, 3));
  EXPECT_THAT(without.vertices_without_face(), ElementsAre(0, 1));
  EXPECT_EQ(without.distances(0), Eigen::Vector2d::Constant(kInfinity));
}

TEST(BadIndices, AreNamedWithTheirTriangle) {
  for (const int bad : {6, -1}) {
    Shape shape = test::octahedron();
    shape.triangles(3, 1) = bad;
    const auto names = ThrowsMessage<std::invalid_argument>(
        "triangle 3 uses vertex " + std::to_string(bad) + ", expected 0 to 5");
    EXPECT_THAT([&] { heat_on(shape); }, names);
    EXPECT_THAT([&] { ExactGeodesics(shape.positions, shape.triangles); }, names);
  }
}

TEST(PositionsThatAreNotFinite, AreNamedWithTheirTriangle) {
  for (const double bad : {kInfinity, std::nan("")}) {
    Shape shape = test::octahedron();
    shape.positions(4, 1) = bad;
    EXPECT_THAT([&] { heat_on(shape); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr("triangle 0 uses vertex 4, whose position is not finite")));
  }
}

TEST(TurnedTriangles, ChangeNothing) {
  const Shape shape = test::bumpy_sphere(3);
  Shape turned = shape;
  for (Eigen::Index t = 1; t < turned.triangles.rows(); t += 3) {
    std::swap(turned.triangles(t, 1), turned.triangles(t, 2));
  }
  EXPECT_LT(relative_error(heat_on(turned).distances(9), heat_on(shape).distances(9)),
            test::kHeatRounding);
  EXPECT_LT(relative_error(ExactGeodesics(turned.positions, turned.triangles).distances(9),
                           ExactGeodesics(shape.positions, shape.triangles).distances(9)),
            test::kHeatRounding);
}

/// Distances from vertex 0, 0 on page 0 of a book, to each page unfolded next to page 0.
Eigen::VectorXd unfolded(const test::Book& book, int x0, int y0) {
  Eigen::VectorXd expected(book.shape.positions.rows());
  for (int page = 0; page < 3; ++page) {
    for (int y = 0; y < book.side; ++y) {
      for (int x = 0; x < book.side; ++x) {
        expected[book.vertex(page, x, y)] = std::hypot(x - x0, page == 0 ? y - y0 : y + y0);
      }
    }
  }
  return expected;
}

TEST(EdgesOfThreeTriangles, LetHeatPassToEverySheet) {
  const test::Book book = test::book(16);
  const Eigen::VectorXd expected = unfolded(book, 7, 5);
  for (const bool intrinsic : {true, false}) {
    const HeatGeodesics heat = heat_on(book.shape, {.intrinsic_delaunay = intrinsic});
    // Half an edge's error on distances of ten edges.
    EXPECT_LT(mean_error(heat.distances(book.vertex(0, 7, 5)), expected), 0.05);
  }
}

TEST(EdgesOfThreeTriangles, LetExactDistancesPassAtTheirVertices) {
  const test::Book book = test::book(10);
  const ExactGeodesics exact(book.shape.positions, book.shape.triangles);
  const Eigen::VectorXd distances = exact.distances(book.vertex(0, 4, 3));
  const Eigen::VectorXd expected = unfolded(book, 4, 3);
  EXPECT_GE((distances - expected).minCoeff(), -test::kHeatRounding);
  // A detour to a vertex at most half an edge away.
  EXPECT_LT((distances - expected).maxCoeff(), 0.25);
}

TEST(SheetsThatTouchAtAVertex, AreJoinedThere) {
  const int side = 12, touch = side * side - 1, source = 3 * side + 4;
  const Shape shape = test::touching_squares(side);
  Eigen::VectorXd expected = test::euclidean(shape.positions, source);
  const Eigen::VectorXd beyond = test::euclidean(shape.positions, touch).array() + expected[touch];
  expected.tail(touch) = beyond.tail(touch);

  const ExactGeodesics exact(shape.positions, shape.triangles);
  EXPECT_LT(relative_error(exact.distances(source), expected), test::kHeatRounding);
  // Some edges' error on ten, and the bottleneck of one vertex.
  EXPECT_LT(mean_error(heat_on(shape).distances(source), expected), 0.1);
}

TEST(OneSidedSurfaces, HaveDistancesAcrossTheirSeam) {
  const Shape strip = test::moebius_strip(60, 9);
  const HeatGeodesics heat = heat_on(strip);
  const ExactGeodesics exact(strip.positions, strip.triangles);
  const VertexIndex beside_the_seam = 3 * 9 + 4;
  EXPECT_LT(mean_error(heat.distances(beside_the_seam), exact.distances(beside_the_seam)), 0.05);
}

TEST(DoubledTriangles, AreNoHindrance) {
  Shape shape = test::bumpy_sphere(3);
  const Eigen::VectorXd expected = heat_on(shape).distances(0);
  shape =
      with_triangle(shape, shape.triangles(40, 0), shape.triangles(40, 1), shape.triangles(40, 2));
  // One triangle of 512 conducts twice.
  EXPECT_LT(relative_error(heat_on(shape).distances(0), expected), 0.02);
}

}  // namespace
}  // namespace mimetra::geodesic
