#include <array>
#include <cstring>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "geodesic/exact_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "tests/geodesic/surfaces.h"
#include "tests/shared_data.h"

namespace mimetra::geodesic {
namespace {

using test::relative_error;
using test::Shape;

ExactGeodesics exact_on(const Shape& shape) {
  return {shape.positions, shape.triangles};
}

// Unfolding is a chain of some tens of roundings.
constexpr double kRounding = 1e-12;

TEST(ExactGeodesics, AreEuclideanInThePlane) {
  const Shape grid = test::grid(9, 7);
  EXPECT_LT(relative_error(exact_on(grid).distances(20), test::euclidean(grid.positions, 20)),
            kRounding);
}

TEST(ExactGeodesics, GoAroundAnOctahedronOverItsFaces) {
  const Eigen::VectorXd distances = exact_on(test::octahedron()).distances(0);
  // Two faces unfolded: twice the height of an equilateral triangle of side sqrt(2).
  EXPECT_NEAR(distances[1], std::sqrt(6.0), kRounding);
  EXPECT_NEAR(distances[2], std::sqrt(2.0), kRounding);
}

TEST(ExactGeodesics, ApproachTheGreatCircleFromBelow) {
  const Shape sphere = test::sphere(3);
  const double to_pole = exact_on(sphere).distances(0)[1];
  EXPECT_LT(to_pole, std::numbers::pi);
  // A polygon of 32 sides has pi^2 / (6 * 16^2) = 0.6 % less than its circle.
  EXPECT_GT(to_pole, 0.99 * std::numbers::pi);
}

TEST(ExactGeodesics, AreSymmetric) {
  const Shape shape = test::bumpy_sphere(3);
  const ExactGeodesics exact = exact_on(shape);
  EXPECT_NEAR(exact.distances(11)[200], exact.distances(200)[11], kRounding);
}

TEST(ExactGeodesics, AreTheNearestOfSeveralSources) {
  const ExactGeodesics exact = exact_on(test::bumpy_sphere(3));
  const std::array<VertexIndex, 2> sources = {11, 200};
  EXPECT_LT(
      relative_error(exact.distances(sources), exact.distances(11).cwiseMin(exact.distances(200))),
      kRounding);
}

TEST(ExactGeodesics, AreNotChangedByDoubledFaces) {
  const Shape once = test::bumpy_sphere(3);
  Shape twice = once;
  const Eigen::Index count = once.triangles.rows();
  twice.triangles.conservativeResize(count + count / 2, 3);
  for (Eigen::Index t = 0; t < count / 2; ++t) {
    // Of either side, from any corner.
    const auto corners = once.triangles.row(2 * t);
    twice.triangles.row(count + t) << corners[1], corners[t % 2 == 0 ? 2 : 0],
        corners[t % 2 == 0 ? 0 : 2];
  }
  EXPECT_EQ(exact_on(twice).distances(11), exact_on(once).distances(11));
}

TEST(ExactGeodesics, AreInfiniteOnOtherComponents) {
  const Shape two = test::both(test::octahedron(), test::octahedron());
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd distances = exact_on(two).distances(8);
  EXPECT_EQ(distances.head(6), Eigen::VectorXd::Constant(6, infinity));
  EXPECT_TRUE(distances.tail(6).allFinite());
}

TEST(ExactGeodesics, RefuseSourcesThatDoNotExist) {
  const ExactGeodesics exact = exact_on(test::octahedron());
  EXPECT_THROW(exact.distances(-1), std::out_of_range);
  EXPECT_THROW(exact.distances(6), std::out_of_range);
  EXPECT_THROW(exact.distances(std::span<const VertexIndex>()), std::invalid_argument);
}

TEST(ExactGeodesics, AgreeWithTheHeatMethod) {
  const Shape shape = test::bumpy_sphere(4);
  const HeatGeodesics heat(shape.positions, shape.triangles);
  // First order in the edge length, here a thirtieth of the way round.
  EXPECT_LT(test::mean_error(heat.distances(50), exact_on(shape).distances(50)), 0.03);
}

/// The first `count` values of a NumPy file of version 1.
template <typename Value>
std::vector<Value> read_values(const std::filesystem::path& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 10> start{};
  file.read(start.data(), start.size());
  std::uint16_t header = 0;
  std::memcpy(&header, start.data() + 8, sizeof header);
  file.seekg(header, std::ios::cur);
  std::vector<Value> values(count);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(count * sizeof(Value)));
  return values;
}

TEST(ExactGeodesics, AgreeWithTheHeatMethodOnAFace) {
  const auto folder = test::shared_path("oracle/splocs");
  MIMETRA_SKIP_WITHOUT(folder);
  const auto verts = read_values<float>(folder / "verts.npy", 3448 * 3);
  const auto tris = read_values<std::int32_t>(folder / "tris.npy", 6736 * 3);
  const Positions positions =
      Eigen::Map<const Eigen::Matrix<float, -1, 3, Eigen::RowMajor>>(verts.data(), 3448, 3)
          .cast<double>();
  const Triangles triangles = Eigen::Map<const Triangles>(tris.data(), 6736, 3);
  const HeatGeodesics heat(positions, triangles);
  const Eigen::VectorXd expected = ExactGeodesics(positions, triangles).distances(100);
  ASSERT_EQ(heat.degenerate_triangles(), 0);
  ASSERT_TRUE(expected.allFinite());
  // Diffusion over one mean edge, on edges that differ by tens: twice what a sphere shows.
  EXPECT_LT(test::mean_error(heat.distances(100), expected), 0.04);
}

}  // namespace
}  // namespace mimetra::geodesic
