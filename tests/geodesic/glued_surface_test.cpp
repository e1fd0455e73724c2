#include <gmock/gmock.h>

#include "geodesic/glued_surface.h"
#include "tests/geodesic/surfaces.h"

namespace mimetra::geodesic {
namespace {

using test::Shape;

GluedSurface glued_shape(const Shape& shape) {
  return glued(shape.positions.rows(), shape.triangles);
}

std::ptrdiff_t borders(const GluedSurface& surface) {
  return std::count(surface.twin.begin(), surface.twin.end(), -1);
}

/// Twins are each other's twins and run the other way between the same vertices.
void expect_sound(const GluedSurface& surface) {
  const auto from = [&](int h) { return surface.triangles(h / 3, h % 3); };
  const auto to = [&](int h) { return surface.triangles(h / 3, (h % 3 + 1) % 3); };
  for (int h = 0; h < static_cast<int>(surface.twin.size()); ++h) {
    const int twin = surface.twin[h];
    if (twin < 0) continue;
    EXPECT_EQ(surface.twin[twin], h);
    EXPECT_EQ(from(h), to(twin));
    EXPECT_EQ(to(h), from(twin));
  }
}

TEST(GluedSurface, OfAManifoldIsTheMeshItself) {
  const Shape shape = test::grid(4, 3);
  const GluedSurface surface = glued_shape(shape);
  expect_sound(surface);
  EXPECT_EQ(surface.triangles, shape.triangles);
  EXPECT_EQ(static_cast<Eigen::Index>(surface.vertex.size()), shape.positions.rows());
  EXPECT_EQ(borders(surface), 2 * 3 + 2 * 2);
}

TEST(GluedSurface, TurnsTrianglesThatRunTheWrongWay) {
  Shape shape = test::octahedron();
  const Triangles expected = shape.triangles;
  for (const int t : {2, 3, 7}) std::swap(shape.triangles(t, 1), shape.triangles(t, 2));
  const GluedSurface surface = glued_shape(shape);
  expect_sound(surface);
  EXPECT_EQ(borders(surface), 0);
  EXPECT_EQ(surface.triangles, expected);
}

TEST(GluedSurface, LeavesAnEdgeOfThreeTrianglesOpen) {
  const test::Book book = test::book(3);
  const GluedSurface surface = glued_shape(book.shape);
  expect_sound(surface);
  // Three pages of their own: three times the border and the vertices of one.
  EXPECT_EQ(borders(surface), 3 * 8);
  EXPECT_EQ(surface.vertex.size(), 3u * 9);
}

TEST(GluedSurface, RepeatsAVertexWhereSheetsTouch) {
  const GluedSurface surface = glued_shape(test::touching_squares(3));
  expect_sound(surface);
  EXPECT_EQ(surface.vertex.size(), 2u * 9);
  EXPECT_EQ(std::count(surface.vertex.begin(), surface.vertex.end(), 8), 2);
}

TEST(GluedSurface, OpensTheSeamOfAMoebiusStrip) {
  const int columns = 12, rows = 4;
  const GluedSurface surface = glued_shape(test::moebius_strip(columns, rows));
  expect_sound(surface);
  // The strip's one border, twice as long as the strip, and the triangles along the seam.
  EXPECT_GT(borders(surface), 2 * columns);
  EXPECT_GT(surface.vertex.size(), static_cast<std::size_t>(columns) * rows);
}

}  // namespace
}  // namespace mimetra::geodesic
