#include "toolkit/correspondence/mesh_drawing.h"

#include <algorithm>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using Eigen::Vector3d;

/// A pixel for each unit; the middle of pixel x, y is at x + 0.5, -y - 0.5.
MeshView of_pixels(int pixels) {
  MeshView view;
  view.pixels = pixels;
  view.side = pixels;
  view.centre = Vector3d(pixels / 2.0, -pixels / 2.0, 0);
  return view;
}

Vector3d middle_of_pixel(int x, int y) {
  return {x + 0.5, -y - 0.5, 0};
}

TriMesh triangle_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Positions positions(3, 3);
  positions << a.transpose(), b.transpose(), c.transpose();
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  return {positions, Connectivity::from_triangles(3, triangles)};
}

TriMesh both_of(const TriMesh& a, const TriMesh& b) {
  return test::mesh_of(
      test::both({a.positions, a.connectivity.triangles}, {b.positions, b.connectivity.triangles}));
}

TriMesh reversed(const TriMesh& mesh) {
  return test::mesh_of(
      {mesh.positions, Triangles(mesh.connectivity.triangles.colwise().reverse())});
}

TEST(MeshDrawing, ShowsATriangleAtThePixelsWhoseMiddleItHolds) {
  const MeshPainter painter(triangle_of({1, -7.2, 0}, {7.3, -7.2, 0}, {1, -0.9, 0}));
  const MeshDrawing drawing = painter.draw(of_pixels(8));
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const Vector3d middle = middle_of_pixel(x, y);
      const bool inside = middle.x() > 1 && middle.y() > -7.2 && middle.x() + middle.y() < 0.1;
      const SeenPlace& place = drawing.places[drawing.image.index(x, y)];
      EXPECT_EQ(place.triangle, inside ? 0 : -1) << x << ' ' << y;
      if (!inside) continue;
      EXPECT_NEAR(place.shares.sum(), 1, 1e-12);
      // Vertices are rounded to 1 / 192 of a pixel.
      EXPECT_LT((painter.position(place) - middle).norm(), 1.0 / 192) << x << ' ' << y;
    }
  }
}

TEST(MeshDrawing, LooksAlongTheAxesOfItsView) {
  MeshView view = of_pixels(8);
  // What is up in the mesh leads to the right, its right towards the viewer.
  view.axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  view.centre = Vector3d(5, 4, 4);
  const MeshPainter painter(triangle_of({5, 0.2, 0.2}, {5, 7.8, 0.2}, {5, 0.2, 7.8}));
  const MeshDrawing drawing = painter.draw(view);
  const SeenPlace& place = drawing.places[drawing.image.index(1, 6)];
  ASSERT_EQ(place.triangle, 0);
  EXPECT_LT((painter.position(place) - Vector3d(5, 1.5, 1.5)).norm(), 1.0 / 96);
  EXPECT_EQ(drawing.places[drawing.image.index(6, 1)].triangle, -1);
}

TEST(MeshDrawing, ShowsTheNearestTriangleInAnyOrder) {
  const auto at_depth = [](double z) {
    return triangle_of({-20, -20, z}, {40, -20, z}, {-20, 40, z});
  };
  for (const auto& mesh : {both_of(at_depth(1), at_depth(2)), both_of(at_depth(2), at_depth(1))}) {
    const MeshPainter painter(mesh);
    for (const SeenPlace& place : painter.draw(of_pixels(8)).places) {
      ASSERT_GE(place.triangle, 0);
      EXPECT_NEAR(painter.position(place).z(), 2, 1e-12);
    }
  }
}

MeshView around_a_sphere(int pixels) {
  MeshView view;
  view.pixels = pixels;
  view.side = 2.3;
  view.axes = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  view.light = Vector3d(0.3, 0.5, 1);
  return view;
}

TEST(MeshDrawing, OfTrianglesInAnotherOrderHasTheSameBytes) {
  const TriMesh sphere = test::mesh_of(test::sphere(3));
  // Two at one place, of which either could be seen.
  const TriMesh twice = both_of(sphere, sphere);
  for (const TriMesh& mesh : {sphere, twice}) {
    EXPECT_EQ(MeshPainter(mesh).draw(around_a_sphere(64)).image.pixels,
              MeshPainter(reversed(mesh)).draw(around_a_sphere(64)).image.pixels);
  }
}

TEST(MeshDrawing, LeavesNoGapBetweenNeighbours) {
  const test::Shape grid = test::grid(23, 17);
  MeshView view;
  view.pixels = 50;
  view.centre = Vector3d(11, 8, 0);
  view.axes = Eigen::AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix();
  view.side = 11;
  for (const SeenPlace& place : MeshPainter(test::mesh_of(grid)).draw(view).places) {
    EXPECT_GE(place.triangle, 0);
  }
}

TEST(MeshDrawing, IsBrightestWhereTheSurfaceFacesTheLight) {
  const MeshPainter painter(test::mesh_of(test::sphere(5)));
  MeshView view = around_a_sphere(101);
  view.light = Vector3d(0.6, 0, 0.8);
  const MeshDrawing drawing = painter.draw(view);
  const auto brightest = std::ranges::max_element(drawing.image.pixels);
  const auto place =
      drawing.places[static_cast<std::size_t>(brightest - drawing.image.pixels.begin())];
  ASSERT_GE(place.triangle, 0);
  // 1 - cos of the angle is below a step of the grey values (1 of 185).
  EXPECT_GT((view.axes * painter.position(place)).dot(view.light), 1 - 2.0 / 185);
}

TEST(MeshDrawing, OfAMeshTurnedInsideOutIsTheSame) {
  const test::Shape shape = test::sphere(3);
  test::Shape flipped = shape;
  flipped.triangles.col(1).swap(flipped.triangles.col(2));
  const auto as_it_is = MeshPainter(test::mesh_of(shape)).draw(around_a_sphere(64)).image.pixels;
  const auto inside_out =
      MeshPainter(test::mesh_of(flipped)).draw(around_a_sphere(64)).image.pixels;
  for (std::size_t i = 0; i < as_it_is.size(); ++i) {
    // Sums in another order may round otherwise.
    EXPECT_NEAR(as_it_is[i], inside_out[i], 1);
  }
}

TEST(MeshDrawing, IsDarkWhereAnOpenMeshShowsItsInside) {
  test::Shape half = test::sphere(3);
  Triangles front(half.triangles.rows(), 3);
  int count = 0;
  for (const auto& triangle : half.triangles.rowwise()) {
    if (half.positions(triangle[0], 2) + half.positions(triangle[1], 2) +
            half.positions(triangle[2], 2) >
        0) {
      front.row(count++) = triangle;
    }
  }
  half.triangles = front.topRows(count);
  MeshView view;
  view.pixels = 21;
  view.side = 2.3;
  const MeshPainter painter(test::mesh_of(half));
  const auto middle = [&] { return painter.draw(view).image.pixels[10 * 21 + 10]; };
  EXPECT_GT(middle(), 200);
  view.axes = Eigen::AngleAxisd(EIGEN_PI, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_LT(middle(), 40);
}

TEST(MeshDrawing, NeedsAViewWithASize) {
  const MeshPainter painter(test::mesh_of(test::sphere(1)));
  MeshView view;
  view.side = 0;
  EXPECT_THROW(painter.draw(view), std::invalid_argument);
  view.side = 1;
  view.pixels = 0;
  EXPECT_THROW(painter.draw(view), std::invalid_argument);
  view.pixels = 1;
  view.samples = 2;
  EXPECT_THROW(painter.draw(view), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
