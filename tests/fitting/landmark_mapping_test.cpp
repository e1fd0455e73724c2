#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/landmark_mapping.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Mapping : public testing::Test {
 protected:
  LandmarkMapping read(const std::string& content) {
    std::ofstream(folder_ / "map.txt", std::ios::binary) << content;
    return read_landmark_mapping(folder_ / "map.txt");
  }
  test::TemporaryFolder folder_;
};

TEST_F(Mapping, TakesItsLandmarksFromATrack) {
  const LandmarkTrack track{
      {"eye", "nose", "chin"}, Eigen::RowVector<double, 6>(1, 2, 3, 4, 5, 6), {}, {}};
  const MappedLandmarks mapped = map_landmarks(track, {{"chin", 30}, {"ear", 70}, {"eye", 10}});
  EXPECT_THAT(mapped.vertices, ElementsAre(30, 10));
  EXPECT_EQ(mapped.points, Eigen::RowVector4d(5, 6, 1, 2));
}

TEST_F(Mapping, FindsIbugsLandmarksBesideAModel) {
  EXPECT_THAT(landmarks_beside(folder_.path(), 100), testing::IsEmpty());
  const auto write_mapping = [&](const std::string& lines) {
    std::ofstream(folder_ / "ibug_to_face.txt", std::ios::binary) << lines;
  };
  write_mapping("[landmark_mappings]\n37 = 5\n43 = 6\n");  // no mouth
  EXPECT_THAT(landmarks_beside(folder_.path(), 100), testing::IsEmpty());
  write_mapping("[landmark_mappings]\n37 = 5\n43 = 6\n49 = 99\n");
  using testing::Pair;
  const auto all = ElementsAre(Pair(36, 5), Pair(42, 6), Pair(48, 99));
  EXPECT_THAT(landmarks_beside(folder_.path(), 100), all);
  EXPECT_THAT(landmarks_beside(folder_ / "neutral.obj", 100), all);
  EXPECT_THAT(landmarks_beside(folder_.path(), 99), testing::IsEmpty());
}

TEST_F(Mapping, RefusesATrackOfOtherLandmarks) {
  const LandmarkTrack track{{"chin"}, Eigen::RowVector2d(1, 2), {}, {}};
  EXPECT_THAT(test::message_of<MismatchError>([&] {
                map_landmarks(track, {{"9", 33}});
              }),
              HasSubstr("none of the 1 landmarks is in the mapping; the first is 'chin', the "
                        "mapping's first '9'"));
}

TEST_F(Mapping, RefusesATrackOfFewerNumberedLandmarks) {
  const LandmarkTrack track{{"1", "2", "3"}, Eigen::RowVector<double, 6>(1, 2, 3, 4, 5, 6), {}, {}};
  EXPECT_THAT(test::message_of<MismatchError>([&] {
                map_landmarks(track, {{"3", 30}, {"68", 70}});
              }),
              HasSubstr("the mapping has a landmark '68', but there are only 1 to 3"));
}

LandmarkTrack of_mediapipe() {
  LandmarkTrack track;
  track.points = Eigen::RowVectorXd::LinSpaced(2 * 478, 0, 2 * 478 - 1);
  for (int i = 0; i < 478; ++i) track.names.push_back("mp" + std::to_string(i));
  return track;
}

TEST_F(Mapping, OfIbugTakesThePlacesOfMediaPipe) {
  // The corners of eyes and mouth, the chin, and the tip of the nose.
  const LandmarkMapping mapping = {{"37", 1}, {"40", 2}, {"43", 3}, {"46", 4},
                                   {"49", 5}, {"55", 6}, {"9", 7},  {"31", 8}};
  const MappedLandmarks mapped = map_landmarks(of_mediapipe(), mapping);
  EXPECT_THAT(mapped.vertices, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  const std::vector<int> expected = {33, 133, 362, 263, 61, 291, 152, 4};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(mapped.points(0, static_cast<Eigen::Index>(2 * i)), 2 * expected[i]);
  }
}

TEST_F(Mapping, OfIbugTakes68PlacesOfMediaPipeOnce) {
  LandmarkMapping mapping;
  for (int i = 1; i <= 68; ++i) mapping.emplace_back(std::to_string(i), i);
  const MappedLandmarks mapped = map_landmarks(of_mediapipe(), mapping);
  ASSERT_EQ(mapped.points.cols(), 2 * 68);
  std::set<double> places;
  for (Eigen::Index i = 0; i < 68; ++i) places.insert(mapped.points(0, 2 * i));
  EXPECT_EQ(places.size(), 68U);
}

TEST_F(Mapping, KnowsWhichOfItsVerticesAreIbugs) {
  const LandmarkMapping mapping = {{"37", 12}, {"46", 7}};
  const LandmarkVertices both = {{36, 12}, {45, 7}};
  EXPECT_EQ(map_landmarks(of_mediapipe(), mapping).ibug, both);
  LandmarkTrack track;
  track.names = {"46", "9"};
  track.points = Eigen::RowVector4d(1, 2, 3, 4);
  EXPECT_EQ(map_landmarks(track, mapping).ibug, (LandmarkVertices{{45, 7}}));
  // Of 98 landmarks the 37th is another one.
  track.names.clear();
  for (int i = 1; i <= 98; ++i) track.names.push_back(std::to_string(i));
  track.points = Eigen::RowVectorXd::Zero(2 * 98);
  EXPECT_EQ(map_landmarks(track, mapping).ibug, LandmarkVertices());
}

TEST_F(Mapping, MayNameMediaPipesLandmarks) {
  const MappedLandmarks mapped =
      map_landmarks(of_mediapipe(), read("[landmark_mappings]\nmp468 = 12\nmp1 = 7\n"));
  EXPECT_THAT(mapped.vertices, ElementsAre(12, 7));
  EXPECT_EQ(mapped.points, Eigen::RowVector4d(2 * 468, 2 * 468 + 1, 2, 3));
}

}  // namespace
}  // namespace mimetra
