#include <gtest/gtest.h>

#include "tests/correspondence/cut_sheet.h"
#include "toolkit/correspondence/face_openings.h"

namespace mimetra {
namespace {

using test::kColumns;
using test::kRows;
using test::mouth;
using test::one_frame;
using test::sheet;

TEST(FaceOpenings, AreAsWideAsTheirCornersAreApartAndOpenAsFarAsTheirEdgesPart) {
  const auto found = face_openings(sheet(true, 0.5), mouth());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "mouth");
  EXPECT_DOUBLE_EQ(found[0].width, 24);
  for (const double gap : {0.0, 0.5, 0.9}) {
    EXPECT_NEAR(openness(one_frame(sheet(true, gap)), found)(0, 0), gap / 24, 1e-12) << gap;
  }
}

TEST(FaceOpenings, AreNoneWhereTheSkinHasNoCutOrALandmarkIsMissing) {
  EXPECT_TRUE(face_openings(sheet(false, 0), mouth()).empty());
  LandmarkVertices landmarks = mouth();
  landmarks.pop_back();
  EXPECT_TRUE(face_openings(sheet(true, 0.5), landmarks).empty());
}

TEST(FaceOpenings, RefuseALandmarkThatIsNoVertex) {
  EXPECT_THROW(face_openings(sheet(false, 0), {{48, -1}}), std::invalid_argument);
  EXPECT_THROW(face_openings(sheet(false, 0), {{48, kColumns * kRows}}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
