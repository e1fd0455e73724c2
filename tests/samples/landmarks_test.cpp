#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "tests/samples/head_fixture.h"

namespace mimetra::test {
namespace {

std::map<int, Eigen::RowVector3d> places() {
  std::map<int, Eigen::RowVector3d> places;
  for (const auto& [landmark, vertex] : samples::head_landmarks()) {
    places[landmark] = head().mean().row(vertex);
  }
  return places;
}

TEST(HeadLandmarks, AreAllOfIbugsButTheOutlineOfTheView) {
  std::set<int> expected = {9};
  for (int i = 18; i <= 68; ++i) expected.insert(i);
  std::set<int> found, vertices;
  for (const auto& [landmark, vertex] : samples::head_landmarks()) {
    found.insert(landmark);
    vertices.insert(vertex);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(vertices.size(), expected.size());
}

TEST(HeadLandmarks, OfLeftAndRightAreMirrorImages) {
  const auto at = places();
  const std::pair<int, int> kPairs[] = {{18, 27}, {20, 25}, {22, 23}, {32, 36}, {37, 46},
                                        {38, 45}, {40, 43}, {41, 48}, {49, 55}, {50, 54},
                                        {60, 56}, {61, 65}, {62, 64}, {68, 66}};
  for (const auto& [right, left] : kPairs) {
    // iBUG counts from the picture's left, the person's right, which is at negative x.
    EXPECT_LT(at.at(right).x(), 0) << right;
    EXPECT_EQ(at.at(right).x(), -at.at(left).x()) << right;
    EXPECT_EQ(at.at(right).tail<2>(), at.at(left).tail<2>()) << right;
  }
}

TEST(HeadLandmarks, FollowTheFaceDownwards) {
  const auto at = places();
  const int kDown[] = {25, 45, 47, 36, 52, 63, 67, 58, 9};
  for (std::size_t i = 1; i < std::size(kDown); ++i) {
    EXPECT_LT(at.at(kDown[i]).y(), at.at(kDown[i - 1]).y()) << kDown[i];
  }
  for (const int ridge : {28, 29, 30}) EXPECT_LT(at.at(ridge + 1).y(), at.at(ridge).y());
  // The tip of the nose stands out.
  for (const auto& [landmark, place] : at) EXPECT_LE(place.z(), at.at(31).z()) << landmark;
}

TEST(HeadLandmarks, OfTheLipsPartWhenTheJawOpens) {
  const int jaw_open = head().expressions().find("jawOpen");
  Eigen::VectorXd beta = Eigen::VectorXd::Zero(head().expressions().size());
  beta[jaw_open] = 1;
  const Positions open = head().person().pose(beta);
  std::map<int, VertexIndex> vertex;
  for (const auto& [landmark, index] : samples::head_landmarks()) vertex[landmark] = index;
  EXPECT_GT(open(vertex.at(63), 1) - open(vertex.at(67), 1), 10);
}

}  // namespace
}  // namespace mimetra::test
