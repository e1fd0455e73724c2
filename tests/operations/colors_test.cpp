#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/operations/colors.h"

namespace mimetra {
namespace {

/// Relative luminance of an sRGB colour (IEC 61966-2-1).
double luminance(const Color& color) {
  const auto linear = [](double byte) {
    const double s = byte / 255;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.red) + 0.7152 * linear(color.green) + 0.0722 * linear(color.blue);
}

TEST(EvenColor, OnlyGetsDarker) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(luminance(even_color(i / 100.0)), luminance(even_color((i + 1) / 100.0))) << i;
  }
}

/// CIE lightness L* is another measure of evenness than the one the colours are made with.
TEST(EvenColor, FallsAboutEquallyFastInLightness) {
  const auto lightness = [](double share) {
    return 116 * std::cbrt(luminance(even_color(share))) - 16;
  };
  const double mean = (lightness(0) - lightness(1)) / 10;
  for (int i = 0; i < 10; ++i) {
    const double step = lightness(i / 10.0) - lightness((i + 1) / 10.0);
    EXPECT_GT(step, 0.5 * mean) << i;
    EXPECT_LT(step, 1.7 * mean) << i;
  }
}

TEST(EvenColor, TakesTheEndsOutsideItsRange) {
  EXPECT_EQ(even_color(-1), even_color(0));
  EXPECT_EQ(even_color(std::numeric_limits<double>::infinity()), even_color(1));
  EXPECT_EQ(even_color(std::nan("")), kNoValue);
}

TEST(CategoryColors, OfOneThatTouchesTenOthersIsAnother) {
  // A fan of ten categories around the last one, in the middle.
  Triangles fan(10, 3);
  std::vector<int> categories;
  for (int i = 0; i < 10; ++i) {
    fan.row(i) << i, (i + 1) % 10, 10;
    categories.push_back(i);
  }
  categories.push_back(10);
  const std::vector<Color> colors = category_colors(categories, fan);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NE(colors[std::size_t(i)], colors[10]);
    EXPECT_NE(colors[std::size_t(i)], colors[std::size_t((i + 1) % 10)]);
  }
}

TEST(CategoryColors, DifferWhereCategoriesTouch) {
  const test::Shape shape = test::grid(20, 20);
  std::vector<int> categories;
  categories.reserve(400);
  for (int v = 0; v < 400; ++v) categories.push_back(v / 20 / 4 * 5 + v % 20 / 4);
  const std::vector<Color> colors = category_colors(categories, shape.triangles);
  for (Eigen::Index t = 0; t < shape.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(shape.triangles(t, i));
      const auto b = static_cast<std::size_t>(shape.triangles(t, (i + 1) % 3));
      EXPECT_EQ(categories[a] == categories[b], colors[a] == colors[b]) << a << ' ' << b;
    }
  }
}

TEST(CategoryColors, LeaveWhatHasNoCategoryAsItIs) {
  const std::vector<Color> colors =
      category_colors({-1, 2000000000, 2000000000}, test::grid(2, 2).triangles.topRows(0));
  EXPECT_EQ(colors[0], kClay);
  EXPECT_NE(colors[1], kClay);
  EXPECT_EQ(colors[1], colors[2]);
}

TEST(RegionColorField, HasTheColorOfMostCornersOnEachFace) {
  // Two quads and two triangles in a row.
  const Connectivity connectivity = Connectivity::from_polygons(
      9, {{0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6, 4, 7, 8}, {0, 4, 8, 11, 14}});
  const std::vector<int> labels = {0, 2, 2, 0, 2, 2, -1, -1, -1};
  const Field region{"region", Field::Location::vertices,
                     Eigen::Map<const Eigen::VectorXi>(labels.data(), 9).cast<double>(), true};
  const std::vector<Color> colors = category_colors(labels, connectivity.triangles);
  const Field found = region_color_field(region, connectivity);
  EXPECT_EQ(found.name, "region_color");
  EXPECT_EQ(found.location, Field::Location::triangles);
  // A draw between 0 and 2, region 2, a draw of three, nothing.
  const std::vector<Color> expected = {colors[0], colors[1], kClay, kClay};
  ASSERT_EQ(found.values.rows(), 6);
  for (int t = 0; t < 6; ++t) {
    const Color& color = expected[std::size_t(connectivity.polygon_of_triangle[std::size_t(t)])];
    EXPECT_EQ(found.values.row(t), Eigen::RowVector3d(color.red, color.green, color.blue)) << t;
  }
}

TEST(ColorsByCategory, AreThoseOfTheVertices) {
  const test::Shape shape = test::grid(4, 4);
  const std::vector<int> categories = {0, 0, 2, 2, 0, 0, 2, 2, -1, -1, 5, 5, -1, -1, 5, 5};
  const std::vector<Color> of_vertices = category_colors(categories, shape.triangles);
  const std::vector<Color> colors = colors_by_category(categories, shape.triangles, 4);
  ASSERT_EQ(colors.size(), 4U);
  EXPECT_EQ(colors[0], of_vertices[0]);
  EXPECT_EQ(colors[1], kClay);
  EXPECT_EQ(colors[2], of_vertices[2]);
  EXPECT_TRUE(colors_by_category({2000000000}, test::grid(2, 2).triangles.topRows(0), 0).empty());
}

}  // namespace
}  // namespace mimetra
