#include <gmock/gmock.h>

#include <limits>
#include <thread>

#include "geodesic/exact_geodesics.h"
#include "tests/shapes.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {
namespace {

using test::Shape;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A grid cut along the column x = `cut`: its vertices appear twice, the copies at the end.
struct CutGrid {
  Shape shape;
  /// Copy of vertex (cut, y).
  int copy(int y) const { return copies + y; }
  int copies;
};

CutGrid cut_grid(int columns, int rows, int cut) {
  const Shape whole = test::grid(columns, rows);
  const int vertices = columns * rows;
  CutGrid result{{Positions(vertices + rows, 3), whole.triangles}, vertices};
  result.shape.positions.topRows(vertices) = whole.positions;
  for (int y = 0; y < rows; ++y) {
    result.shape.positions.row(vertices + y) = whole.positions.row(y * columns + cut);
  }
  for (auto triangle : result.shape.triangles.rowwise()) {
    if (triangle.unaryExpr([&](int v) { return v % columns; }).maxCoeff() <= cut) continue;
    for (int& v : triangle) {
      if (v % columns == cut) v = vertices + v / columns;
    }
  }
  return result;
}

SurfaceDistances welded_distances(const Shape& shape,
                                  GeodesicMethod method = GeodesicMethod::heat) {
  return {shape.positions, shape.triangles, Weld::exact(shape.positions), method};
}

TEST(SurfaceDistances, PassAcrossASeamThatIsWelded) {
  const CutGrid cut = cut_grid(9, 5, 4);
  const Shape whole = test::grid(9, 5);
  for (const auto method : {GeodesicMethod::heat, GeodesicMethod::heat_direct,
                            GeodesicMethod::exact, GeodesicMethod::cgal}) {
    const SurfaceDistances distances = welded_distances(cut.shape, method);
    const SurfaceDistances expected(whole.positions, whole.triangles, Weld::none(45), method);
    EXPECT_EQ(distances(2).head(45), expected(2));
  }
}

TEST(SurfaceDistances, AreTheSameWhereTheyAreNotKept) {
  const Shape sheet = test::grid(9, 5);
  const SurfaceDistances distances(sheet.positions, sheet.triangles, Weld::none(45));
  const std::vector<VertexIndex> sources = {3, 17, 3, 44};
  const Eigen::MatrixXd once = distances.once(sources);
  EXPECT_EQ(distances.computed(), 0);
  EXPECT_TRUE(once == distances(sources));
  EXPECT_THROW(distances.once(std::vector<VertexIndex>{45}), std::out_of_range);
}

TEST(SurfaceDistances, StopAtASeamThatIsNotWelded) {
  const CutGrid cut = cut_grid(9, 5, 4);
  const SurfaceDistances distances(cut.shape.positions, cut.shape.triangles,
                                   Weld::none(static_cast<int>(cut.shape.positions.rows())));
  EXPECT_EQ(distances(2)[8], std::numeric_limits<double>::infinity());
}

TEST(SurfaceDistances, AreEqualForWeldedVertices) {
  const CutGrid cut = cut_grid(9, 5, 4);
  const SurfaceDistances distances = welded_distances(cut.shape);
  const Eigen::VectorXd from_left = distances(2);
  for (int y = 0; y < 5; ++y) EXPECT_EQ(from_left[cut.copy(y)], from_left[y * 9 + 4]);
  EXPECT_EQ(distances(cut.copy(1)), distances(1 * 9 + 4));
  EXPECT_EQ(distances(cut.copy(1))[1 * 9 + 4], 0);
}

TEST(SurfaceDistances, AreComputedOncePerPlace) {
  const CutGrid cut = cut_grid(9, 5, 4);
  const SurfaceDistances distances = welded_distances(cut.shape);
  const SurfaceDistances copy = distances;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(distances.computed(), 0);
  distances(0);
  distances(0);
  distances(cut.copy(2));
  copy(2 * 9 + 4);
  EXPECT_EQ(distances.computed(), 2);
  EXPECT_EQ(copy.computed(), 2);
}

TEST(SurfaceDistances, OfTheLatestSourcesAreKeptAsFarAsTheyAreAllowedTo) {
  const Shape shape = test::grid(9, 5);
  const auto weld = Weld::none(45);
  const SurfaceDistances all(shape.positions, shape.triangles, weld);
  const std::vector<VertexIndex> requests = {3, 9, 3, 40, 3, 9, 40};
  // Two fit; 40 is computed while 9 is the one that was asked for longest ago.
  const SurfaceDistances two(shape.positions, shape.triangles, weld, GeodesicMethod::heat,
                             2 * 45 * sizeof(double));
  const std::vector<int> computed = {1, 2, 2, 3, 3, 4, 5};
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(two(requests[i]), all(requests[i]));
    EXPECT_EQ(two.computed(), computed[i]) << i;
  }
  const SurfaceDistances none(shape.positions, shape.triangles, weld, GeodesicMethod::heat, 0);
  EXPECT_EQ(none(requests), all(requests));
  EXPECT_EQ(none(requests), all(requests));
  EXPECT_EQ(none.computed(), 6);
  EXPECT_EQ(all.computed(), 3);
}

TEST(SurfaceDistances, FromEachOfSeveralAreThoseFromOneAfterTheOther) {
  const Shape shape = test::grid(9, 7);
  const std::vector<VertexIndex> sources = {3, 9, 3, 40, 1, 2, 5, 7, 11, 13, 17, 19};
  for (const auto method : {GeodesicMethod::heat, GeodesicMethod::exact}) {
    const SurfaceDistances together = welded_distances(shape, method);
    const SurfaceDistances alone = welded_distances(shape, method);
    const Eigen::MatrixXd distances = together(sources);
    EXPECT_EQ(together.computed(), 11);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      EXPECT_EQ(distances.col(i), alone(sources[i])) << sources[i];
    }
  }
}

TEST(OneByOne, AsksInTheOrderGiven) {
  std::vector<VertexIndex> asked;
  const DistanceFunction distances = one_by_one([&asked](VertexIndex source) {
    asked.push_back(source);
    return Eigen::VectorXd(Eigen::VectorXd::Constant(2, source));
  });
  const std::vector<VertexIndex> sources = {5, 1, 5};
  EXPECT_EQ(distances(sources), (Eigen::MatrixXd(2, 3) << 5, 1, 5, 5, 1, 5).finished());
  EXPECT_EQ(asked, sources);
}

TEST(SurfaceDistances, AreTheSameFromSeveralThreads) {
  const Shape shape = test::sphere(2);
  const SurfaceDistances distances = welded_distances(shape);
  std::vector<Eigen::VectorXd> results(4);
  {
    std::vector<std::jthread> threads;
    threads.reserve(results.size());
    for (auto& result : results) threads.emplace_back([&] { result = distances(7); });
  }
  for (const auto& result : results) EXPECT_EQ(result, welded_distances(shape)(7));
  EXPECT_EQ(distances.computed(), 1);
}

TEST(SurfaceDistances, OfTheExactMethodAreExact) {
  const Shape shape = test::sphere(2);
  EXPECT_EQ(welded_distances(shape, GeodesicMethod::exact)(3),
            geodesic::ExactGeodesics(shape.positions, shape.triangles).distances(3));
}

TEST(SurfaceDistances, CountTrianglesThatWeldingCollapses) {
  Shape shape = test::octahedron();
  shape.positions.conservativeResize(7, 3);
  shape.positions.row(6) = shape.positions.row(0);
  shape.triangles.conservativeResize(9, 3);
  shape.triangles.row(8) << 0, 6, 2;
  EXPECT_EQ(welded_distances(shape).degenerate_triangles(), 1);
  EXPECT_EQ(welded_distances(shape, GeodesicMethod::exact).degenerate_triangles(), 1);
}

TEST(SurfaceDistances, NameEveryVertexOfAPlaceWithoutFace) {
  CutGrid cut = cut_grid(5, 4, 2);
  Positions& positions = cut.shape.positions;
  positions.conservativeResize(positions.rows() + 2, 3);
  positions.bottomRows(2) << 0, 0, 9, 0, 0, 9;
  EXPECT_THAT(welded_distances(cut.shape).vertices_without_face(),
              ElementsAre(positions.rows() - 2, positions.rows() - 1));
}

TEST(SurfaceDistances, FromTheNearestOfSeveralAreTheSameByCgal) {
  const Shape shape = test::grid(20, 20);
  const Weld none = Weld::none(int(shape.positions.rows()));
  const std::vector<VertexIndex> sources = {0, 21, 42, 200};
  const SurfaceDistances heat(shape.positions, shape.triangles, none, GeodesicMethod::heat);
  const SurfaceDistances cgal(shape.positions, shape.triangles, none, GeodesicMethod::cgal);
  EXPECT_TRUE(cgal.from_nearest(sources).isApprox(heat.from_nearest(sources), 1e-12));
}

TEST(SurfaceDistances, RefuseSourcesThatDoNotExist) {
  const SurfaceDistances distances = welded_distances(test::octahedron());
  EXPECT_THROW(distances(-1), std::out_of_range);
  EXPECT_THROW(distances(6), std::out_of_range);
  EXPECT_EQ(distances.computed(), 0);
}

TEST(SurfaceDistances, RefuseABadIndexByName) {
  Shape shape = test::octahedron();
  shape.triangles(2, 0) = 6;
  EXPECT_THAT([&] { welded_distances(shape); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("triangle 2 uses vertex 6")));
}

TEST(SurfaceDistances, RefuseAWeldOfAnotherMesh) {
  const Shape shape = test::octahedron();
  EXPECT_THAT([&] { SurfaceDistances(shape.positions, shape.triangles, Weld::none(5)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a weld of 5 vertices, expected 6")));
}

}  // namespace
}  // namespace mimetra
