#include "toolkit/mesh/outline.h"

#include <gmock/gmock.h>

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Outline, IsThePolygonThatFacesMakeTogether) {
  const Polygons faces{{0, 1, 2, 0, 2, 3, 2, 4, 3}, {0, 3, 6, 9}};
  EXPECT_THAT(outline(faces, {0}), ElementsAre(0, 1, 2));
  EXPECT_THAT(outline(faces, {0, 1}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(outline(faces, {0, 1, 2}), ElementsAre(0, 1, 2, 4, 3));
}

TEST(Outline, IsNoneOfFacesThatMakeNoPolygon) {
  // Two apart, two that meet in a corner, two wound against each other, one that is closed.
  EXPECT_THAT(outline({{0, 1, 2, 3, 4, 5}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 2, 3, 4}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 0, 3, 2}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{0, 1, 2, 2, 1, 0}, {0, 3, 6}}, {0, 1}), IsEmpty());
  EXPECT_THAT(outline({{}, {0}}, {}), IsEmpty());
}

}  // namespace
}  // namespace mimetra
