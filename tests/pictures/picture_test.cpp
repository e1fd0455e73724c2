#include <cmath>

#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/drawing/chart.h"
#include "toolkit/drawing/picture.h"
#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// A flat square of 2 x 2 units that faces the eye.
Sheet square_sheet(double scale = 1, double shift = 0) {
  const test::Shape shape = test::grid(3, 3);
  Sheet sheet;
  TileRow row;
  row.connectivity =
      std::make_shared<Connectivity>(Connectivity::from_triangles(9, shape.triangles));
  Positions positions = scale * shape.positions;
  positions.array() += shift;
  row.tiles.push_back({positions, std::vector<Color>(9, Color{200, 40, 40}), 0});
  sheet.rows.push_back(row);
  sheet.tile_height = 100;
  return sheet;
}

bool is_red(const Color& color) {
  return color.red > 80 && color.green < color.red / 2 && color.blue < color.red / 2;
}

/// Pixels of the mesh's colour.
int red_pixels(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += is_red(image.at(x, y));
  }
  return count;
}

TEST(Picture, ShowsAMeshInItsColourAndScaleOnWhite) {
  const Sheet sheet = square_sheet();
  const SheetLayout layout = SheetLayout::of(sheet);
  const Image image = draw(sheet);
  ASSERT_EQ(image.width, layout.width);
  ASSERT_EQ(image.height, layout.height);
  const Box tile = layout.tile(0, 0);
  EXPECT_TRUE(is_red(image.at(tile.left + tile.width / 2, tile.top + tile.height / 2)));
  EXPECT_EQ(image.at(0, 0), (Color{255, 255, 255}));
  // Two units wide and high; a pixel's width of doubt along the border.
  const double side = 2 * layout.pixels_per_unit();
  EXPECT_NEAR(red_pixels(image), side * side, 4 * side);
}

TEST(Picture, DoesNotDependOnUnitOrOrigin) {
  const Image image = draw(square_sheet());
  for (const double scale : {1e-6, 1e6}) {
    const int tolerance = 4 * 100;  // a pixel's width along the border
    EXPECT_NEAR(red_pixels(draw(square_sheet(scale, 1000 * scale))), red_pixels(image), tolerance);
  }
}

TEST(Picture, ShowsCrispColoursWithoutAnyBetweenThem) {
  Sheet sheet = square_sheet();
  Tile& tile = sheet.rows[0].tiles[0];
  for (int v = 0; v < 9; ++v)
    tile.colors[std::size_t(v)] = v < 3 ? Color{0, 0, 255} : Color{0, 255, 0};
  const auto between = [&sheet] {
    const Image image = draw(sheet);
    const Box box = SheetLayout::of(sheet).tile(0, 0);
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
      const Color& pixel = image.at(box.left + box.width / 2, y);
      count += pixel.red < 100 && pixel.green > 60 && pixel.blue > 60;
    }
    return count;
  };
  EXPECT_GT(between(), 5);  // 50 pixels from one colour to the other
  tile.crisp = true;
  EXPECT_LE(between(), 2);  // of the samples of a pixel on the border
  // The lowest row of vertices has the lowest quarter.
  const SheetLayout layout = SheetLayout::of(sheet);
  const Image image = draw(sheet);
  const Box box = layout.tile(0, 0);
  int blue = 0;
  for (int y = 0; y < image.height; ++y) {
    const Color& pixel = image.at(box.left + box.width / 2, y);
    blue += pixel.blue > 100 && pixel.green < 60;
  }
  EXPECT_NEAR(blue, 0.5 * layout.pixels_per_unit(), 1.5);
}

/// The square as four quads, with another one behind it, which it hides.
Sheet quads_sheet() {
  Sheet sheet = square_sheet();
  TileRow& row = sheet.rows.front();
  std::vector<int> corners, offsets = {0};
  for (const int first : {0, 1, 3, 4, 9, 10, 12, 13}) {
    for (const int corner : {first, first + 1, first + 4, first + 3}) corners.push_back(corner);
    offsets.push_back(static_cast<int>(corners.size()));
  }
  row.connectivity =
      std::make_shared<Connectivity>(Connectivity::from_polygons(18, {corners, offsets}));
  Tile& tile = row.tiles.front();
  tile.colors.resize(18, tile.colors.front());
  Positions both(18, 3);
  both << tile.positions, 0.8 * tile.positions;
  both.bottomRows(9).col(2).array() -= 0.5;
  tile.positions = both;
  return sheet;
}

TEST(Picture, ShowsTheEdgesOfPolygonsThatAreSeenAndNotOfTheirTriangles) {
  Sheet sheet = quads_sheet();
  const SheetLayout layout = SheetLayout::of(sheet);
  const Box box = layout.tile(0, 0);
  const double unit = layout.pixels_per_unit();
  // Whether anything is dark on the way between two points, in units from the middle.
  const auto is_crossed = [&](const Image& image, double from_x, double from_y, double to_x,
                              double to_y) {
    bool crossed = false;
    for (double t = 0; t <= 1; t += 0.01) {
      const double x = from_x + t * (to_x - from_x), y = from_y + t * (to_y - from_y);
      const Color color = image.at(static_cast<int>(box.left + box.width / 2.0 + x * unit),
                                   static_cast<int>(box.top + box.height / 2.0 + y * unit));
      crossed |= color.red < 110;
    }
    return crossed;
  };
  const Image plain = draw(sheet);
  sheet.edges = true;
  const Image lined = draw(sheet);
  EXPECT_FALSE(is_crossed(plain, -0.5, 0.3, 0.5, 0.3));
  EXPECT_TRUE(is_crossed(lined, -0.5, 0.3, 0.5, 0.3));  // the edge in the middle
  // Ways across diagonals of quads and borders of the hidden square.
  for (const double y : {-0.5, 0.5}) EXPECT_FALSE(is_crossed(lined, 0.1, y, 0.9, y));
  EXPECT_FALSE(is_crossed(lined, 0.3, 0.1, 0.3, 0.9));
}

TEST(Picture, WritesLabelsWhereTheyAre) {
  Sheet sheet = square_sheet();
  const Image plain = draw(sheet);
  sheet.rows[0].tiles[0].labels = {{"7", Eigen::RowVector3d(2, 2, 0)}};
  const Image labelled = draw(sheet);
  const SheetLayout layout = SheetLayout::of(sheet);
  const Box box = layout.tile(0, 0);
  double x_sum = 0, y_sum = 0, count = 0;
  for (int y = 0; y < plain.height; ++y) {
    for (int x = 0; x < plain.width; ++x) {
      if (plain.at(x, y) == labelled.at(x, y)) continue;
      x_sum += x, y_sum += y, ++count;
    }
  }
  ASSERT_GT(count, 10);
  // The upper right corner of the square, whose middle is the tile's.
  EXPECT_NEAR(x_sum / count, box.left + box.width / 2.0 + layout.pixels_per_unit(), 3);
  EXPECT_NEAR(y_sum / count, box.top + box.height / 2.0 - layout.pixels_per_unit(), 3);
}

TEST(SheetLayout, HasRoomForALegendOfManyNumbers) {
  Sheet sheet = square_sheet();
  const SheetLayout plain = SheetLayout::of(sheet);
  for (int number = 0; number < 30; ++number) {
    sheet.rows[0].legend.entries.push_back({number, {0, 0, 0}});
  }
  const SheetLayout layout = SheetLayout::of(sheet);
  const int columns = layout.legend_columns(sheet.rows[0].legend);
  EXPECT_GE(columns * layout.legend_lines(), 30);
  EXPECT_GE(layout.width - plain.width, SheetLayout::kLegendColumn * columns * layout.text);
  EXPECT_LE(SheetLayout::kLegendLine * layout.legend_lines() * layout.text, layout.tile_height);
}

TEST(Picture, IsTheSameInASessionWhateverWasDrawnBefore) {
  Sheet large = square_sheet(), small = square_sheet();
  large.tile_height = 160;
  large.rows.push_back(large.rows[0]);
  Chart chart;
  chart.title = "time";
  chart.series.push_back({"all", {1, 2}, {3, 1}, Color{255, 0, 0}});
  const auto all = [&] {
    return std::vector<Image>{draw(large), draw(small), draw({chart}), draw(small), draw(large)};
  };
  const std::vector<Image> alone = all();
  const DrawingSession outer;
  for (int round = 0; round < 2; ++round) {
    const DrawingSession session;
    const std::vector<Image> together = all();
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(together[i].width, alone[i].width) << i;
      EXPECT_TRUE(together[i].pixels == alone[i].pixels) << i;
    }
    EXPECT_THROW(draw(large, Context().with_progress([](double) { return false; })), Cancelled);
  }
  EXPECT_TRUE(draw(large).pixels == alone[0].pixels);
}

TEST(Picture, HasAScaleBarOfTheLengthItSays) {
  Sheet sheet = square_sheet();
  sheet.rows[0].tiles[0].colors.assign(9, Color{255, 255, 255});
  const SheetLayout layout = SheetLayout::of(sheet);
  const Image image = draw(sheet);
  const double length = round_length(layout.tile_width / 3.0 / layout.pixels_per_unit());
  int longest = 0;
  for (int y = layout.height - 2 * layout.text; y < layout.height; ++y) {
    int run = 0;
    for (int x = 0; x < layout.width; ++x) {
      run = image.at(x, y).red < 60 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  EXPECT_NEAR(longest, length * layout.pixels_per_unit(), 1.5);
}

TEST(Picture, OfNothingIsRefused) {
  EXPECT_THROW(draw(Sheet{}), std::invalid_argument);
  Sheet huge = square_sheet();
  huge.tile_height = 20000;
  EXPECT_THROW(draw(huge), std::invalid_argument);
}

TEST(Picture, IsWrittenAsPng) {
  const std::string bytes = png_of(Image(2, 1, {255, 0, 0}));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\2\0\0\0\1", 8));
}

TEST(SheetLayout, LeavesALineAboveTilesWithATitle) {
  Sheet sheet = square_sheet();
  sheet.letters = 17;
  const SheetLayout plain = SheetLayout::of(sheet);
  EXPECT_EQ(plain.text, 17);
  sheet.rows[0].tiles[0].title = "1: 25 mm";
  const SheetLayout titled = SheetLayout::of(sheet);
  EXPECT_EQ(titled.tile(0, 0).top, plain.tile(0, 0).top + 2 * 17);
  EXPECT_EQ(titled.height, plain.height + 2 * 17);
}

TEST(Picture, WritesTheTitlesOfTiles) {
  Sheet sheet = square_sheet();
  const auto dark_above = [&sheet] {
    const SheetLayout layout = SheetLayout::of(sheet);
    const Image image = draw(sheet);
    int count = 0;
    for (int y = 0; y < layout.tile(0, 0).top; ++y) {
      for (int x = 0; x < image.width; ++x) count += image.at(x, y).green < 128;
    }
    return count;
  };
  EXPECT_EQ(dark_above(), 0);
  sheet.rows[0].tiles[0].title = "title";
  EXPECT_GT(dark_above(), 10);
}

}  // namespace
}  // namespace mimetra
