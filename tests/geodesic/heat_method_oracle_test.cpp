// CGAL's own query, which takes 20 s to compile: no other test sees it.

// Its default solver.
#define CGAL_EIGEN3_ENABLED

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <gtest/gtest.h>

#include "geodesic/heat_geodesics.h"
#include "tests/geodesic/surfaces.h"

namespace mimetra::geodesic {
namespace {

using test::Shape;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

template <typename Mode>
Eigen::VectorXd distances_by_cgal(const Shape& shape, std::span<const VertexIndex> sources) {
  Mesh mesh;
  for (const auto p : shape.positions.rowwise()) mesh.add_vertex(Point(p[0], p[1], p[2]));
  const auto vertex = [](int v) { return Mesh::Vertex_index(v); };
  for (const auto t : shape.triangles.rowwise()) {
    mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  const auto result = mesh.add_property_map<Mesh::Vertex_index, double>("v:distance", 0).first;
  CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh, Mode> heat_method(mesh);
  for (const VertexIndex source : sources) heat_method.add_source(vertex(source));
  heat_method.estimate_geodesic_distances(result);
  Eigen::VectorXd distances(shape.positions.rows());
  for (const auto v : mesh.vertices()) distances[v.idx()] = result[v];
  return distances;
}

/// The shape without its first triangles: it has a border.
Shape open_shape() {
  Shape shape = test::bumpy_sphere(4);
  shape.triangles = shape.triangles.bottomRows(shape.triangles.rows() - 200).eval();
  Shape opened{{}, shape.triangles};
  std::vector<int> number(shape.positions.rows(), -1), used;
  for (int& v : opened.triangles.reshaped<Eigen::RowMajor>()) {
    if (number[v] < 0) {
      number[v] = static_cast<int>(used.size());
      used.push_back(v);
    }
    v = number[v];
  }
  opened.positions = shape.positions(used, Eigen::all);
  return opened;
}

// Both factor the same matrices. What is left is rounding, 1e-16 times the conditions of the heat
// step and of the Poisson system, each below 1e4 for some thousand triangles.
constexpr double kRounding = 1e-9;

TEST(HeatMethodOracle, AgreesOnTheIntrinsicDelaunayTriangulation) {
  for (const Shape& shape : {test::bumpy_sphere(4), open_shape()}) {
    const HeatGeodesics heat(shape.positions, shape.triangles);
    for (const VertexIndex source : {0, 17, 400}) {
      const auto expected =
          distances_by_cgal<CGAL::Heat_method_3::Intrinsic_Delaunay>(shape, {&source, 1});
      EXPECT_LT(test::relative_error(heat.distances(source), expected), kRounding);
    }
  }
}

TEST(HeatMethodOracle, AgreesOnTheMeshAsIs) {
  for (const Shape& shape : {test::bumpy_sphere(4), open_shape()}) {
    const HeatGeodesics heat(shape.positions, shape.triangles, {.intrinsic_delaunay = false});
    for (const VertexIndex source : {0, 17, 400}) {
      const auto expected = distances_by_cgal<CGAL::Heat_method_3::Direct>(shape, {&source, 1});
      EXPECT_LT(test::relative_error(heat.distances(source), expected), kRounding);
    }
  }
}

TEST(HeatMethodOracle, AgreesForSeveralSources) {
  const Shape shape = test::bumpy_sphere(4);
  const std::vector<VertexIndex> sources = {5, 77, 600};
  EXPECT_LT(test::relative_error(
                HeatGeodesics(shape.positions, shape.triangles).distances(sources),
                distances_by_cgal<CGAL::Heat_method_3::Intrinsic_Delaunay>(shape, sources)),
            kRounding);
}

}  // namespace
}  // namespace mimetra::geodesic
