#include <array>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "geodesic/heat_geodesics.h"
#include "tests/geodesic/surfaces.h"

namespace mimetra::geodesic {
namespace {

using test::heat_on;
using test::mean_error;
using test::relative_error;
using test::Shape;

/// Great-circle distance on the unit sphere.
Eigen::VectorXd great_circle(const Shape& sphere, VertexIndex from) {
  return (sphere.positions * sphere.positions.row(from).transpose()).array().max(-1).min(1).acos();
}

/// From vertex 5 of bumpy_sphere(3), computed once.
const Eigen::VectorXd& distances_on_bumps() {
  static const Eigen::VectorXd distances = heat_on(test::bumpy_sphere(3)).distances(5);
  return distances;
}

TEST(HeatGeodesics, HalvesItsErrorOnASphereWithEachRefinement) {
  for (const bool intrinsic : {true, false}) {
    double previous = 0.15;
    for (const int levels : {2, 3, 4, 5}) {
      const Shape sphere = test::sphere(levels);
      const HeatGeodesics heat = heat_on(sphere, {.intrinsic_delaunay = intrinsic});
      const double error = mean_error(heat.distances(3), great_circle(sphere, 3));
      // At best of first order in the edge length, which halves; the smoothing of the source and of
      // the cut locus, where gradients meet, costs the rest.
      EXPECT_LT(error, previous * 0.6) << levels << " levels";
      previous = error;
    }
  }
}

TEST(HeatGeodesics, AreEuclideanOnAFlatGrid) {
  const Shape grid = test::grid(31, 31);
  const VertexIndex middle = 15 * 31 + 15;
  // 15 edges from the middle to the side: an error of about one edge length is 5 % on the mean.
  EXPECT_LT(mean_error(heat_on(grid).distances(middle), test::euclidean(grid.positions, middle)),
            0.05);
}

TEST(HeatGeodesics, AreZeroAtTheSourceAndPositiveElsewhere) {
  const Shape shape = test::bumpy_sphere(3);
  const HeatGeodesics heat = heat_on(shape);
  for (const VertexIndex source : {0, 100, 257}) {
    Eigen::VectorXd distances = heat.distances(source);
    EXPECT_EQ(distances[source], 0);
    distances[source] = 1;
    EXPECT_GT(distances.minCoeff(), 0);
  }
}

TEST(HeatGeodesics, TakeASourceTwiceAsOnce) {
  const HeatGeodesics heat = heat_on(test::bumpy_sphere(2));
  const std::array<VertexIndex, 2> twice = {7, 7};
  EXPECT_EQ(heat.distances(twice), heat.distances(7));
}

TEST(HeatGeodesics, DoNotChangeUnderRigidMotion) {
  Shape shape = test::bumpy_sphere(3);
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  shape.positions = (shape.positions * rotation.transpose()).eval();
  shape.positions.rowwise() += Eigen::RowVector3d(4, -5, 6);
  EXPECT_LT(relative_error(heat_on(shape).distances(5), distances_on_bumps()), test::kHeatRounding);
}

TEST(HeatGeodesics, DoNotChangeFarFromTheOrigin) {
  Shape shape = test::bumpy_sphere(3);
  shape.positions.rowwise() += Eigen::RowVector3d(1e6, -1e6, 1e6);
  // Coordinates of 1e6 are known to 1e-10, edges of 0.1 to 1e-9; a hundred for the conditions.
  EXPECT_LT(relative_error(heat_on(shape).distances(5), distances_on_bumps()), 1e-7);
}

TEST(HeatGeodesics, ScaleWithTheMesh) {
  const Shape shape = test::bumpy_sphere(3);
  const Eigen::VectorXd& expected = distances_on_bumps();
  for (const double scale : {1e-6, 1e6}) {
    const Shape scaled{shape.positions * scale, shape.triangles};
    EXPECT_LT(relative_error(heat_on(scaled).distances(5), expected * scale), test::kHeatRounding);
  }
}

TEST(HeatGeodesics, FollowTheOrderOfTheVertices) {
  const Shape shape = test::bumpy_sphere(3);
  const int vertices = static_cast<int>(shape.positions.rows());
  Shape reversed = shape;
  reversed.positions = shape.positions.colwise().reverse();
  reversed.triangles = (vertices - 1 - shape.triangles.array()).matrix();
  EXPECT_LT(
      relative_error(heat_on(reversed).distances(vertices - 1 - 5).reverse(), distances_on_bumps()),
      test::kHeatRounding);
}

TEST(HeatGeodesics, AreInfiniteOnOtherComponents) {
  const Shape one = test::bumpy_sphere(2);
  const int vertices = static_cast<int>(one.positions.rows());
  const HeatGeodesics heat = heat_on(test::both(one, test::octahedron()));
  const Eigen::VectorXd distances = heat.distances(0);
  EXPECT_TRUE(distances.head(vertices).allFinite());
  EXPECT_TRUE((distances.tail(6).array() == std::numeric_limits<double>::infinity()).all());
  // What is elsewhere does not matter: the diffusion time is the component's own.
  EXPECT_EQ(distances.head(vertices), heat_on(one).distances(0));
}

TEST(HeatGeodesics, StartOnEveryComponentThatHasASource) {
  const Shape one = test::bumpy_sphere(2);
  const int vertices = static_cast<int>(one.positions.rows());
  const std::array<VertexIndex, 2> sources = {4, vertices + 2};
  const Eigen::VectorXd distances = heat_on(test::both(one, one)).distances(sources);
  EXPECT_EQ(distances.head(vertices), heat_on(one).distances(4));
  EXPECT_EQ(distances.tail(vertices), heat_on(one).distances(2));
}

TEST(HeatGeodesics, FromEachOfManyAreThoseOfOneQueryEach) {
  // More sources than one group holds, on two components; on the strip the heat fades.
  const int length = 800;
  const HeatGeodesics heat = heat_on(test::both(test::grid(length, 2), test::bumpy_sphere(2)));
  std::vector<VertexIndex> sources = {0, 0, length / 2};
  for (VertexIndex source = 0; source < HeatGeodesics::kGroup; ++source) {
    sources.push_back(2 * length + 5 * source);
    sources.push_back(7 * source);
  }
  const Eigen::MatrixXd together = heat.distances_from_each(sources);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    EXPECT_EQ(together.col(i), heat.distances(sources[i])) << sources[i];
  }
}

TEST(HeatGeodesics, AreZeroWhereEveryVertexIsASource) {
  // The heat is constant: it has no direction, on triangles of any size.
  for (const double size : {1e-3, 1.0, 1e3}) {
    const Shape octahedron = test::octahedron();
    const HeatGeodesics heat(size * octahedron.positions, octahedron.triangles);
    const std::array<VertexIndex, 6> all = {0, 1, 2, 3, 4, 5};
    EXPECT_TRUE(heat.distances(all).isZero(0)) << size;
  }
}

TEST(HeatGeodesics, ReachTheFarEndOfALongStrip) {
  // Heat falls by about e per edge: after 700 of them it has underflown.
  const int length = 1200;
  const Shape strip = test::grid(length, 3);
  const Eigen::VectorXd distances = heat_on(strip).distances(0);
  ASSERT_TRUE(distances.allFinite());
  // CGAL adds 1e-8 per triangle to the Laplacian, whose lowest eigenvalue is (pi / length)^2 =
  // 7e-6 here: up to 1 %, beside the method's own error, which is an edge or two.
  EXPECT_NEAR(distances[length - 1], length - 1, 0.02 * length);
}

TEST(HeatGeodesics, EndWhereManyVerticesLieOnACircle) {
  // Regular polygons as caps: every triangulation is Delaunay, and rounding decides between them.
  // On these CGAL's flips alone would not end.
  for (const int sides : {29, 52, 60, 71, 98}) {
    Shape prism{Positions(2 * sides, 3), Triangles(4 * sides - 4, 3)};
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      prism.positions.row(i) << std::cos(angle), std::sin(angle), 0;
      prism.positions.row(sides + i) << std::cos(angle), std::sin(angle), 0.1;
    }
    int t = 0;
    for (int i = 0; i < sides; ++i) {
      const int j = (i + 1) % sides;
      prism.triangles.row(t++) << i, j, sides + j;
      prism.triangles.row(t++) << i, sides + j, sides + i;
    }
    for (int i = 1; i + 1 < sides; ++i) {
      prism.triangles.row(t++) << 0, i + 1, i;
      prism.triangles.row(t++) << sides, sides + i, sides + i + 1;
    }
    EXPECT_TRUE(heat_on(prism).distances(0).allFinite()) << sides << " sides";
  }
}

TEST(HeatGeodesics, MayBeMoved) {
  const Shape shape = test::bumpy_sphere(2);
  HeatGeodesics first = heat_on(shape);
  const Eigen::VectorXd expected = first.distances(1);
  const HeatGeodesics second = std::move(first);
  EXPECT_EQ(second.distances(1), expected);
}

TEST(HeatGeodesics, RefuseSourcesThatDoNotExist) {
  const HeatGeodesics heat = heat_on(test::octahedron());
  EXPECT_THROW(heat.distances(-1), std::out_of_range);
  EXPECT_THROW(heat.distances(6), std::out_of_range);
  const std::array<VertexIndex, 2> sources = {0, 6};
  EXPECT_THROW(heat.distances(sources), std::out_of_range);
  EXPECT_THROW(heat.distances(std::span<const VertexIndex>()), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra::geodesic
