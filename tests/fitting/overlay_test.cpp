#include <algorithm>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fitting/overlay.h"
#include "tests/temporary_folder.h"

namespace mimetra {
namespace {

constexpr Color kGrey = {100, 100, 100};
/// Two thirds of grey, one of cyan.
constexpr Color kEdge = {66, 151, 151};
constexpr Color kYellow = {255, 230, 0};
constexpr Color kMagenta = {255, 0, 255};
constexpr Color kRed = {255, 0, 0};

Image grey() {
  return {12, 12, kGrey};
}

/// A square of two triangles, counter-clockwise where y is down.
FittedView square() {
  FittedView view;
  view.vertices.resize(4, 2);
  view.vertices << 1, 1, 1, 9, 9, 9, 9, 1;
  return view;
}

Triangles triangles() {
  Triangles result(2, 3);
  result << 0, 1, 2, 0, 2, 3;
  return result;
}

int count(const Image& image, const Color& color) {
  return static_cast<int>(std::count(image.pixels.begin(), image.pixels.end(), color));
}

TEST(Overlay, MixesEachPixelOfAnEdgeOnce) {
  const Image drawn = draw_fit(grey(), triangles(), square());
  // Four sides of 9 pixels that share their corners, and a diagonal of 7 more.
  EXPECT_EQ(count(drawn, kEdge), 4 * 8 + 7);
  EXPECT_EQ(count(drawn, kGrey), 12 * 12 - (4 * 8 + 7));
  EXPECT_EQ(drawn.at(5, 5), kEdge);
  EXPECT_EQ(drawn.at(1, 4), kEdge);
  EXPECT_EQ(drawn.at(4, 2), kGrey);
}

TEST(Overlay, LeavesOutTrianglesSeenFromBehind) {
  Triangles one_turned = triangles();
  one_turned.row(1) << 0, 3, 2;
  const Image drawn = draw_fit(grey(), one_turned, square());
  EXPECT_EQ(drawn.at(9, 4), kGrey);  // a side of the turned one only
  EXPECT_EQ(drawn.at(5, 5), kEdge);  // the diagonal belongs to the other one too
}

TEST(Overlay, LeavesOutWhatIsOutsideTheImage) {
  FittedView view = square();
  view.vertices.row(2) << 1e300, 9;
  view.vertices.row(3) << 900, 1;
  Triangles far = triangles();
  far.row(1) << 0, 1, 3;
  view.landmarks = ImagePoints::Constant(1, 2, -500);
  const Image drawn = draw_fit(grey(), far, view);
  EXPECT_EQ(drawn.at(11, 1), kEdge);
  EXPECT_EQ(count(drawn, kYellow), 0);
}

TEST(Overlay, MarksFoundLandmarksTheModelsOwnAndTheWayBetween) {
  FittedView view = square();
  view.landmarks.resize(1, 2);
  view.landmarks << 4.4, 5.6;
  view.landmark_vertices = {2};
  const Image drawn = draw_fit(grey(), Triangles(0, 3), view);
  EXPECT_EQ(drawn.at(4, 6), kYellow);
  EXPECT_EQ(count(drawn, kYellow), 9);
  EXPECT_EQ(drawn.at(9, 9), kMagenta);
  EXPECT_EQ(count(drawn, kMagenta), 9);
  EXPECT_GT(count(drawn, kRed), 0);
}

TEST(Overlay, DrawsOnlyTheModelsOwnWhereALandmarkWasNotSeen) {
  FittedView view = square();
  view.landmarks.setConstant(1, 2, std::numeric_limits<double>::quiet_NaN());
  view.landmark_vertices = {2};
  const Image drawn = draw_fit(grey(), Triangles(0, 3), view);
  EXPECT_EQ(count(drawn, kYellow), 0);
  EXPECT_EQ(count(drawn, kRed), 0);
  EXPECT_EQ(count(drawn, kMagenta), 9);
}

TEST(Overlay, RefusesVerticesThatAreNotThereAndAnotherNumberOfLandmarks) {
  Triangles beyond = triangles();
  beyond(1, 2) = 4;
  const auto message = [](const Triangles& faces, const FittedView& seen) {
    return test::message_of<std::invalid_argument>([&] { draw_fit(grey(), faces, seen); });
  };
  const char* nowhere = "a triangle or landmark has a vertex that is none of the 4";
  EXPECT_EQ(message(beyond, square()), nowhere);
  FittedView view = square();
  view.landmark_vertices = {-1};
  view.landmarks.setZero(1, 2);
  EXPECT_EQ(message(triangles(), view), nowhere);
  view.landmark_vertices = {0, 1};
  EXPECT_EQ(message(triangles(), view), "2 vertices for 1 landmarks");
}

TEST(Overlay, OfACloseUpHasTheMeshWhereItWas) {
  FittedView view;
  view.vertices.resize(4, 2);
  view.vertices << 20, 30, 20, 70, 60, 70, 60, 30;
  view.landmarks.resize(1, 2);
  view.landmarks << 40, 40;
  // A tenth of 40 on each side: 49 columns and rows from 16, 26 on, each twice.
  const Image drawn = draw_close_up(Image(100, 100, kGrey), triangles(), view, 98);
  EXPECT_EQ(drawn.width, 98);
  EXPECT_EQ(drawn.height, 98);
  EXPECT_EQ(drawn.at(2 * (20 - 16) + 1, 50), kEdge);
  EXPECT_EQ(drawn.at(2 * (40 - 16) + 1, 2 * (40 - 26) + 1), kYellow);
  EXPECT_EQ(drawn.at(2, 50), kGrey);
}

TEST(Overlay, OfACloseUpEndsWithTheImage) {
  FittedView view = square();
  const Image drawn = draw_close_up(grey(), triangles(), view, 11);
  EXPECT_EQ(drawn.width, 11);  // 1 .. 9 and a pixel more on each side
  view.vertices.array() += 5;
  EXPECT_EQ(draw_close_up(grey(), triangles(), view, 7).width, 7);  // 5 .. 11
  view.vertices.array() += 1e300;
  EXPECT_THROW(draw_close_up(grey(), triangles(), view, 7), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
