#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/option_ranges.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "tests/vtk/vtp_fixture.h"
#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/pictures/film_strip.h"

namespace mimetra {
namespace {

using test::message_of;
using testing::HasSubstr;

/// A quad and a triangle; frame f is moved by f along z.
FieldSequence rising(int frames) {
  FieldSequence fields = test::quad_and_triangle();
  const MeshSequence& still = fields.sequence();
  Frames moved(frames, still.positions().cols());
  for (int f = 0; f < frames; ++f) {
    moved.row(f) = still.positions().row(0);
    for (int v = 0; v < still.vertices(); ++v) moved(f, 3 * v + 2) += f;
  }
  return {MeshSequence(still.shared_connectivity(), moved, Eigen::VectorXd(), still.rest()),
          fields.fields, fields.displacement};
}

TEST(FilmStrip, ShowsTheFirstAndLastFrameAndThoseBetweenEvenly) {
  const Sheet sheet = film_strip({rising(10)}, {.columns = 4});
  ASSERT_EQ(sheet.rows.front().tiles.size(), 4u);
  for (int column = 0; column < 4; ++column) {
    EXPECT_EQ(sheet.rows[0].tiles[column].positions(0, 2), 3 * column);
  }
  EXPECT_EQ(sheet.column_titles.back(), "0.30 s");
}

TEST(FilmStrip, ColoursDisplacementByItsShareOfTheLargest) {
  const Sheet sheet = film_strip({rising(5)}, {.columns = 5, .colors = {StripColor::displacement}});
  const TileRow& row = sheet.rows.front();
  EXPECT_EQ(row.bar->maximum, 4);
  for (int column = 0; column < 5; ++column) {
    EXPECT_EQ(row.tiles[column].colors.front(), even_color(column / 4.0));
  }
}

TEST(FilmStrip, ColoursTheDifferenceFromTheRowAbove) {
  const Sheet sheet = film_strip(
      {rising(1), rising(3)}, {.columns = 3, .colors = {StripColor::none, StripColor::difference}});
  EXPECT_TRUE(sheet.rows[0].tiles[0].colors.empty());
  EXPECT_FALSE(sheet.rows[0].bar);
  EXPECT_EQ(sheet.rows[1].bar->maximum, 2);
  EXPECT_EQ(sheet.rows[1].tiles[2].colors.front(), even_color(1));
}

TEST(FilmStrip, ShowsCategoriesWithoutABarAndNumbersWithOne) {
  const FieldSequence fields = rising(1);
  EXPECT_FALSE(film_strip({fields}, {.colors = {"region"}}).rows[0].bar);
  const TileRow row = film_strip({fields}, {.colors = {"in_L"}}).rows[0];
  EXPECT_EQ(row.bar->maximum, 1);
  // Triangles 0 and 2 are outside, triangle 1 holds the vertices 0, 2 and 3.
  EXPECT_EQ(row.tiles[0].colors[3], even_color(1));
  EXPECT_EQ(row.tiles[0].colors[4], even_color(0));
}

TEST(FilmStrip, ShowsRegionsThatCoverTheWholeMeshAsCategories) {
  FieldSequence fields = rising(1);
  fields.fields[0].values << 0, 0, 1, 1, 2;
  const TileRow row = film_strip({fields}, {.colors = {"region"}}).rows[0];
  EXPECT_FALSE(row.bar);
  EXPECT_NE(row.tiles[0].colors[0], row.tiles[0].colors[2]);
}

TEST(FilmStrip, NamesItsColours) {
  const Sheet sheet = film_strip({rising(2), rising(2), rising(2)},
                                 {.colors = {StripColor::displacement, "in_L", "region"}});
  EXPECT_EQ(sheet.rows[0].bar->name, "displacement");
  EXPECT_EQ(sheet.rows[1].bar->name, "in_L");
  EXPECT_TRUE(sheet.rows[1].legend.entries.empty());
  const Legend& legend = sheet.rows[2].legend;
  EXPECT_EQ(legend.name, "region");
  ASSERT_EQ(legend.entries.size(), 4U);  // of -1, 0, 1, 2^24 + 1 and 2
  EXPECT_EQ(legend.entries[2].number, 2);
  EXPECT_EQ(legend.entries[2].color, sheet.rows[2].tiles[0].colors[4]);
}

TEST(FilmStrip, NumbersTheRegionsThatAreSeen) {
  FieldSequence fields = rising(2);
  fields.fields[0].values << 0, 0, 1, 1, -1;
  const TileRow row = film_strip({fields}, {.colors = {"region"}, .viewpoint = {0, 0}}).rows[0];
  EXPECT_TRUE(row.tiles[0].crisp);
  ASSERT_EQ(row.tiles[0].labels.size(), 2U);
  EXPECT_EQ(row.tiles[0].labels[1].text, "1");
  EXPECT_TRUE(row.tiles[1].labels.empty());
  const TileRow back = film_strip({fields}, {.colors = {"region"}, .viewpoint = {180, 0}}).rows[0];
  EXPECT_TRUE(back.tiles[0].labels.empty());
}

TEST(FilmStrip, NumbersRegionsInTheirMiddleAndNoneThatAreHidden) {
  // Three sheets of 9 x 9 vertices, one behind the other: the nearest covers the left half.
  const test::Shape sheet = test::grid(9, 9);
  Positions rest(3 * 81, 3);
  Triangles triangles(3 * sheet.triangles.rows(), 3);
  for (int i = 0; i < 3; ++i) {
    rest.middleRows(81 * i, 81) = sheet.positions.rowwise() + Eigen::RowVector3d(0, 0, -i);
    triangles.middleRows(i * sheet.triangles.rows(), sheet.triangles.rows()) =
        sheet.triangles.array() + 81 * i;
  }
  rest.topRows(81).col(0) /= 2;
  Eigen::VectorXd regions(3 * 81);
  regions << Eigen::VectorXd::Constant(81, 4), Eigen::VectorXd::Constant(81, 7),
      Eigen::VectorXd::Constant(81, 9);
  const Frames frames = rest.reshaped<Eigen::RowMajor>().transpose();
  const FieldSequence fields(
      std::make_shared<MeshSequence>(Connectivity::from_triangles(3 * 81, triangles), frames),
      {{"region", Field::Location::vertices, regions, true}});
  const TileRow row = film_strip({fields}, {.colors = {"region"}, .viewpoint = {0, 0}}).rows[0];
  const std::vector<TileLabel>& labels = row.tiles[0].labels;
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_EQ(labels[0].text, "4");
  EXPECT_NEAR(labels[0].position.x(), 2, 0.1);
  EXPECT_EQ(labels[1].text, "7");
  EXPECT_NEAR(labels[1].position.x(), 6, 0.1);
  EXPECT_EQ(labels[1].position.z(), -1);
}

TEST(FilmStrip, TurnsATurntableOnceAround) {
  const Sheet sheet =
      film_strip({rising(3)}, {.layout = StripLayout::turntable, .columns = 4, .frames = {2}});
  ASSERT_EQ(sheet.rows[0].tiles.size(), 4u);
  EXPECT_EQ(sheet.rows[0].tiles[3].turn, 270);
  EXPECT_EQ(sheet.rows[0].tiles[3].positions(0, 2), 2);
}

TEST(FilmStrip, ShowsOneFrameWhereTheLayoutIsOne) {
  EXPECT_EQ(film_strip({rising(3)}, {.layout = StripLayout::frame}).rows[0].tiles.size(), 1u);
  const Sheet sheet = film_strip({rising(3)}, {.layout = StripLayout::frame, .frames = {2}});
  ASSERT_EQ(sheet.rows[0].tiles.size(), 1u);
  EXPECT_EQ(sheet.rows[0].tiles[0].positions(0, 2), 2);
}

TEST(FilmStrip, RefusesOptionsOutOfRange) {
  test::expect_ranges<StripOptions>();
  test::expect_ranges<Viewpoint>();
  EXPECT_THAT(message_of<std::invalid_argument>([] { film_strip({rising(1)}, {.columns = 0}); }),
              HasSubstr("columns is 0"));
  EXPECT_THAT(message_of<std::invalid_argument>(
                  [] { film_strip({rising(1)}, {.viewpoint = {.pitch = 91}}); }),
              HasSubstr("pitch is 91"));
}

TEST(FilmStrip, NamesWhatItCannotShow) {
  EXPECT_THAT(
      message_of<MismatchError>([] { film_strip({rising(1)}, {.colors = {"regoin"}}); }),
      HasSubstr("row 1: no field 'regoin'; it can be coloured by none, displacement, difference, "
                "region, direction, in_L"));
  EXPECT_THAT(message_of<MismatchError>([] {
                film_strip({rising(2), rising(3)}, {});
              }),
              HasSubstr("row 2: 3 frames, expected 2"));
  EXPECT_THAT(message_of<MismatchError>([] { film_strip({rising(2)}, {.frames = {2}}); }),
              HasSubstr("no frame 2 to draw: the last is 1"));
  EXPECT_THAT(message_of<MismatchError>(
                  [] { film_strip({rising(2)}, {.colors = {StripColor::difference}}); }),
              HasSubstr("no row above"));
  EXPECT_THAT(message_of<std::invalid_argument>([] {
                film_strip({rising(2)}, {.colors = {StripColor::none, StripColor::none}});
              }),
              HasSubstr("2 colours for 1 rows"));
}

TEST(SheetLayout, ScalesEveryTileAlikeAndKeepsTheMeshInside) {
  const Sheet sheet =
      film_strip({rising(4)}, {.columns = 4, .viewpoint = {.yaw = 30, .pitch = 20}});
  const SheetLayout layout = SheetLayout::of(sheet);
  const View view = view_of(sheet.viewpoint);
  const double half_width = layout.half_height * layout.tile_width / layout.tile_height;
  for (const Tile& tile : sheet.rows[0].tiles) {
    const Positions centered = tile.positions.rowwise() - layout.centers[0];
    EXPECT_LE((centered * view.up).cwiseAbs().maxCoeff(), layout.half_height);
    EXPECT_LE((centered * view.right).cwiseAbs().maxCoeff(), half_width * (1 + 1e-12));
  }
}

TEST(SheetLayout, LooksAtTheFrontWithTheRightAxisUp) {
  Viewpoint front{.yaw = 0, .pitch = 0};
  EXPECT_TRUE(view_of(front).towards_eye.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(view_of(front, 90).towards_eye.isApprox(Eigen::Vector3d::UnitX()));
  front.up = UpAxis::z;
  EXPECT_TRUE(view_of(front).towards_eye.isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(view_of(front).up.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(view_of(front).right.isApprox(Eigen::Vector3d::UnitX()));
}

TEST(SheetLayout, RoundsLengthsDown) {
  EXPECT_DOUBLE_EQ(round_length(7.3), 5);
  EXPECT_DOUBLE_EQ(round_length(0.0021), 0.002);
  EXPECT_DOUBLE_EQ(round_length(1.9e6), 1e6);
}

}  // namespace
}  // namespace mimetra
