#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "toolkit/mesh/inspection.h"

namespace mimetra {
namespace {

using test::both;
using test::grid;
using test::mesh_of;
using test::octahedron;
using test::triangles_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

MeshReport inspect_shape(const test::Shape& shape) {
  const TriMesh mesh = mesh_of(shape);
  return inspect(mesh.positions, mesh.connectivity);
}

TEST(Inspection, CountsVerticesThatRoundingMovedFromAnother) {
  test::Shape shape = test::both(octahedron(), octahedron());
  EXPECT_EQ(inspect_shape(shape).almost_welded_vertices, 0);
  shape.positions(3, 1) += 1e-8;
  EXPECT_EQ(inspect_shape(shape).almost_welded_vertices, 2);
  shape.positions(3, 1) += 1e-3;
  EXPECT_EQ(inspect_shape(shape).almost_welded_vertices, 0);
}

TEST(Inspection, MeasuresWhatRoundingMovedByTheSurfaceAlone) {
  test::Shape shape = octahedron();
  shape.positions.conservativeResize(8, 3);
  shape.positions.row(6) << 0, 0, 1e9;  // of no triangle
  shape.positions.row(7) << 0, 0, 1e9 + 1;
  EXPECT_EQ(inspect_shape(shape).almost_welded_vertices, 0);
}

TEST(Inspection, CountsManyVerticesThatLieAlmostAtOnePlace) {
  test::Shape shape = test::grid(300, 300);
  shape.positions.topRows(60000) *= 1e-10;
  EXPECT_EQ(inspect_shape(shape).almost_welded_vertices, 60000);
}

TEST(Inspection, CountsTheEdgesAroundATurnedFace) {
  test::Shape shape = octahedron();
  EXPECT_EQ(inspect_shape(shape).inconsistent_edges, 0);
  std::swap(shape.triangles(4, 0), shape.triangles(4, 1));
  EXPECT_EQ(inspect_shape(shape).inconsistent_edges, 3);
}

TEST(Inspection, OfAGridCountsItsRim) {
  const MeshReport report = inspect_shape(grid(5, 4));
  EXPECT_EQ(report.boundary_edges, 2 * (4 + 3));
  EXPECT_EQ(report.vertices, 20);
  EXPECT_EQ(report.triangles, 24);
  EXPECT_EQ(report.extent, Eigen::Vector3d(4, 3, 0));
}

TEST(Inspection, CountsPolygonsAndTheirTriangles) {
  const Connectivity quad = Connectivity::from_polygons(4, {{0, 1, 3, 2}, {0, 4}});
  const MeshReport report = inspect(grid(2, 2).positions, quad);
  EXPECT_EQ(report.faces, 1);
  EXPECT_EQ(report.triangles, 2);
  EXPECT_EQ(report.boundary_edges, 4);
}

TEST(Inspection, CountsAnEdgeOfThreeTriangles) {
  const Connectivity fins =
      Connectivity::from_triangles(5, triangles_of({{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}}));
  Positions positions(5, 3);
  positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1;
  const MeshReport report = inspect(positions, fins);
  EXPECT_EQ(report.nonmanifold_edges, 1);
  EXPECT_EQ(report.boundary_edges, 6);
}

TEST(Inspection, GivesATriangleThatRepeatsAVertexNoEdges) {
  // The collapsed triangle lies in the diagonal that the other two share.
  const Connectivity connectivity =
      Connectivity::from_triangles(4, triangles_of({{{0, 1, 3}}, {{0, 3, 2}}, {{0, 3, 3}}}));
  const MeshReport report = inspect(grid(2, 2).positions, connectivity);
  EXPECT_EQ(report.nonmanifold_edges, 0);
  EXPECT_EQ(report.boundary_edges, 4);
  EXPECT_THAT(report.degenerate_triangles, ElementsAre(2));
}

TEST(Inspection, FindsTrianglesWithoutArea) {
  Positions line(4, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0;
  const Connectivity connectivity =
      Connectivity::from_triangles(4, triangles_of({{{0, 1, 3}}, {{0, 1, 2}}}));
  EXPECT_THAT(inspect(line, connectivity).degenerate_triangles, ElementsAre(1));
}

TEST(Inspection, FindsVerticesWithoutFace) {
  const Connectivity connectivity = Connectivity::from_triangles(5, triangles_of({{{1, 2, 4}}}));
  const MeshReport report = inspect(Positions::Random(5, 3), connectivity);
  EXPECT_THAT(report.vertices_without_face, ElementsAre(0, 3));
  EXPECT_EQ(report.components, 1);
}

TEST(Inspection, WeldsASeam) {
  // Two grids side by side whose touching columns coincide.
  test::Shape right = grid(3, 4);
  right.positions.col(0).array() += 2;
  const MeshReport report = inspect_shape(both(grid(3, 4), right));
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.components_after_welding, 1);
  EXPECT_EQ(report.boundary_edges, 2 * 10);
  EXPECT_EQ(report.boundary_edges_after_welding, 2 * (4 + 3));
  EXPECT_EQ(report.welded_vertices, 4);
}

TEST(Inspection, OfNothingIsEmpty) {
  const MeshReport report = inspect(Positions(0, 3), Connectivity());
  EXPECT_EQ(report.components, 0);
  EXPECT_TRUE(report.extent.isZero(0));
}

TEST(Inspection, RefusesPositionsOfAnotherVertexCount) {
  EXPECT_THAT([] { inspect(Positions(2, 3), Connectivity()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("2 positions, expected 0")));
}

TEST(Inspection, OfFacecapFindsItsPartsAndSeams) {
  const auto path = test::shared_path("data/facecap/neutral.obj");
  MIMETRA_SKIP_WITHOUT(path);
  const TriMesh mesh = test::read_plain_obj(path);
  const MeshReport report = inspect(mesh.positions, mesh.connectivity);
  EXPECT_EQ(report.vertices, 2694);
  EXPECT_EQ(report.triangles, 5032);
  EXPECT_EQ(report.components, 17);
  EXPECT_EQ(report.boundary_edges, 328);
  EXPECT_EQ(report.vertices - report.welded_vertices, 2659);
  EXPECT_EQ(report.components_after_welding, 16);
  EXPECT_EQ(report.boundary_edges_after_welding, 260);
  EXPECT_EQ(report.nonmanifold_edges, 0);
}

TEST(Inspection, OfAManifoldAgreesWithOpenMesh) {
  const test::Shape shape = both(test::sphere(2), grid(7, 5));
  OpenMesh::TriMesh_ArrayKernelT<> mesh;
  for (Eigen::Index v = 0; v < shape.positions.rows(); ++v) mesh.add_vertex({});
  for (const auto& t : shape.triangles.rowwise()) {
    mesh.add_face(mesh.vertex_handle(t[0]), mesh.vertex_handle(t[1]), mesh.vertex_handle(t[2]));
  }
  const auto boundary = std::count_if(mesh.edges_begin(), mesh.edges_end(),
                                      [&](auto edge) { return mesh.is_boundary(edge); });
  EXPECT_EQ(inspect_shape(shape).boundary_edges, boundary);

  const auto neighbors = triangle_neighbors(static_cast<int>(mesh.n_vertices()), shape.triangles);
  for (const auto face : mesh.faces()) {
    std::set<int> expected;
    for (const auto neighbor : mesh.ff_range(face)) expected.insert(neighbor.idx());
    EXPECT_THAT(neighbors[face.idx()], testing::ElementsAreArray(expected));
  }
}

TEST(TriangleNeighbors, AtAnEdgeOfThreeTrianglesAreAllOthers) {
  const auto neighbors =
      triangle_neighbors(5, triangles_of({{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}}));
  EXPECT_THAT(neighbors, ElementsAre(ElementsAre(1, 2), ElementsAre(0, 2), ElementsAre(0, 1)));
}

TEST(TriangleNeighbors, OfATriangleThatRepeatsAVertexLieAtItsEdge) {
  for (const auto& [a, b, c] : {std::array{1, 2, 2}, {1, 2, 1}, {2, 2, 1}}) {
    const auto neighbors =
        triangle_neighbors(3, triangles_of({{{0, 1, 2}}, {{a, b, c}}, {{1, 1, 1}}}));
    EXPECT_THAT(neighbors, ElementsAre(ElementsAre(1), ElementsAre(0), ElementsAre()));
  }
}

TEST(TriangleNeighbors, OfTwoSharedEdgesAreListedOnce) {
  const auto neighbors = triangle_neighbors(3, triangles_of({{{0, 1, 2}}, {{2, 1, 0}}}));
  EXPECT_THAT(neighbors, ElementsAre(ElementsAre(1), ElementsAre(0)));
}

}  // namespace
}  // namespace mimetra
