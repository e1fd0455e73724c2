#include <gtest/gtest.h>

#include "tests/correspondence/cut_sheet.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/pipeline/target.h"

namespace mimetra {
namespace {

/// Frames whose lips are so far apart; the rest pose's by 0.5.
MeshSequence talking(const std::vector<double>& gaps, double scale) {
  TriMesh rest = test::sheet(true, 0.5);
  Frames frames(static_cast<Eigen::Index>(gaps.size()), rest.positions.size());
  for (std::size_t f = 0; f < gaps.size(); ++f) {
    frames.row(static_cast<Eigen::Index>(f)) =
        scale * test::sheet(true, gaps[f]).positions.reshaped<Eigen::RowMajor>().transpose();
  }
  rest.positions *= scale;
  return MeshSequence(rest.connectivity, frames).with_rest(rest.positions);
}

AutomaticMarkers mouths() {
  AutomaticMarkers markers;
  for (const auto& [number, vertex] : test::mouth()) {
    for (FaceLandmarks* face : {&markers.source, &markers.target}) {
      FaceLandmark& landmark = face->found.emplace_back();
      landmark.number = number;
      landmark.vertex = vertex;
    }
  }
  return markers;
}

TEST(ComparedOpenings, AreSharesOfEachFacesOwnWidth) {
  const auto compared = compared_openings(talking({0, 0.9}, 1), talking({0.1, 0.6}, 3), mouths());
  ASSERT_EQ(compared.size(), 1u);
  EXPECT_EQ(compared[0].name, "mouth");
  EXPECT_NEAR(compared[0].source_least, 0, 1e-12);
  EXPECT_NEAR(compared[0].source_most, 0.9 / 24, 1e-12);
  EXPECT_NEAR(compared[0].target_least, 0.1 / 24, 1e-12);
  EXPECT_NEAR(compared[0].target_most, 0.6 / 24, 1e-12);
  EXPECT_NEAR(compared[0].difference, (0.1 + 0.3) / 2 / 24, 1e-12);
}

TEST(ComparedOpenings, TellWhatClosesOnTheSourceOnly) {
  EXPECT_TRUE((ComparedOpening{"mouth", 0.01, 0.5, 0.2, 0.5}).stays_open());
  EXPECT_FALSE((ComparedOpening{"mouth", 0.01, 0.5, 0.03, 0.5}).stays_open());
  EXPECT_FALSE((ComparedOpening{"mouth", 0.3, 0.5, 0.5, 0.6}).stays_open());
}

TEST(OpeningsAtRest, AreThoseOfTheRestPoses) {
  const auto at_rest = openings_at_rest(test::sheet(true, 0.1), test::sheet(true, 0.9), mouths());
  ASSERT_EQ(at_rest.size(), 1u);
  EXPECT_EQ(at_rest[0].name, "mouth");
  EXPECT_NEAR(at_rest[0].source, 0.1 / 24, 1e-12);
  EXPECT_NEAR(at_rest[0].target, 0.9 / 24, 1e-12);
}

TEST(LoneOpenings, AreThoseThatOneFaceHas) {
  const TriMesh cut = test::sheet(true, 0.1), whole = test::sheet(false, 0.1);
  EXPECT_TRUE(lone_openings(cut, cut, mouths()).empty());
  EXPECT_TRUE(lone_openings(whole, whole, mouths()).empty());
  const auto on_source = lone_openings(cut, whole, mouths());
  ASSERT_EQ(on_source.size(), 1U);
  EXPECT_EQ(on_source[0].name, "mouth");
  EXPECT_TRUE(on_source[0].is_sources);
  const auto on_target = lone_openings(whole, cut, mouths());
  ASSERT_EQ(on_target.size(), 1U);
  EXPECT_FALSE(on_target[0].is_sources);
}

TEST(OpeningsAtRest, DifferWhereOneMouthIsOpen) {
  EXPECT_TRUE((OpeningAtRest{"mouth", 0, 0.3}).differs());
  EXPECT_TRUE((OpeningAtRest{"mouth", 0.3, 0}).differs());
  EXPECT_FALSE((OpeningAtRest{"mouth", 0.3, 0.35}).differs());
  EXPECT_FALSE((OpeningAtRest{"left eye", 0.2, 0.4}).differs());
  EXPECT_TRUE((OpeningAtRest{"left eye", 0, 0.35}).differs());
}

TEST(ComparedOpenings, RefuseAnotherNumberOfFrames) {
  EXPECT_THROW(compared_openings(talking({0}, 1), talking({0, 0}, 1), mouths()), MismatchError);
}

}  // namespace
}  // namespace mimetra
