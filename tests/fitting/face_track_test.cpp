#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Outcome = FaceFrame::Outcome;

/// A square face, all of whose landmarks are at its left upper corner.
Face face(double left, double size, double confidence = 0.5) {
  Face result;
  result.left = left;
  result.width = result.height = size;
  result.confidence = confidence;
  result.landmarks.setZero(68, 2);
  result.landmarks.col(0).setConstant(left);
  return result;
}

/// Left borders of the chosen faces; NaN where none was.
std::vector<double> lefts(const FaceTrack& track) {
  const Eigen::VectorXd column = track.landmarks.points.col(0);
  return {column.begin(), column.end()};
}

TEST(FaceTrack, StartsWithTheLargestFace) {
  const FaceTrack track = follow_face({{"a.png", {face(10, 50), face(300, 80), face(500, 80)}}});
  EXPECT_THAT(lefts(track), ElementsAre(300));
  EXPECT_EQ(track.frames[0].faces, 3);
  EXPECT_THAT(track.notes, ElementsAre(AllOf(HasSubstr("1 of 1 images show several faces"),
                                             HasSubstr("the first is a.png"))));
}

TEST(FaceTrack, LeavesOutFramesThatShowOnlySomebodyElse) {
  const FaceTrack track = follow_face({{"0.png", {face(10, 60), face(300, 50)}},
                                       {"1.png", {face(301, 50)}},
                                       {"2.png", {face(12, 60), face(302, 50)}}});
  EXPECT_THAT(lefts(track), ElementsAre(10, testing::IsNan(), 12));
  EXPECT_EQ(track.frames[1].outcome, Outcome::other_face);
  EXPECT_THAT(track.frames[1].note, HasSubstr("others than the one that is followed"));
  EXPECT_EQ(track.landmarks.confidence[1], 0);
  EXPECT_THAT(track.notes,
              ElementsAre(HasSubstr("2 of 3 images show several faces"),
                          HasSubstr("1 of 3 images show only faces of others than the one that is "
                                    "followed, the first is 1.png")));
}

TEST(FaceTrack, SaysWhereTheFaceJumpsAmongSeveral) {
  const FaceTrack track = follow_face(
      {{"0.png", {face(10, 60), face(300, 50)}}, {"1.png", {face(150, 60), face(500, 50)}}});
  EXPECT_THAT(lefts(track), ElementsAre(10, 150));
  EXPECT_THAT(track.notes,
              testing::Contains(HasSubstr("1 of 2 images show the face that is followed elsewhere "
                                          "than before (is it the same person's?), the first is "
                                          "1.png")));
}

TEST(FaceTrack, ReportsEachFrame) {
  const FaceTrack track = follow_face({{"d/0.png", {}},
                                       {"d/1.png", {face(1, 50, 0.05), face(2, 50, 0.02)}},
                                       {"d/2.png", {face(3, 50)}}},
                                      0.1);
  ASSERT_EQ(track.frames.size(), 3u);
  EXPECT_EQ(track.frames[0].outcome, Outcome::no_face);
  EXPECT_EQ(track.frames[0].confidence, 0);
  EXPECT_EQ(track.frames[1].outcome, Outcome::low_confidence);
  EXPECT_EQ(track.frames[1].confidence, 0.05);
  EXPECT_EQ(track.frames[1].faces, 0);
  EXPECT_EQ(track.frames[2].outcome, Outcome::found);
  EXPECT_EQ(track.frames[2].image, "d/2.png");
  EXPECT_TRUE(track.landmarks.points.topRows(2).array().isNaN().all());
  EXPECT_EQ(track.landmarks.confidence, Eigen::Vector3d(0, 0, 0.5));
  EXPECT_THAT(
      track.notes,
      ElementsAre("1 of 3 images show no face that was found, the first is 0.png",
                  "1 of 3 images show only faces of too low confidence, the first is 1.png"));
}

TEST(FaceTrack, HasTheNamesOfIbug) {
  const LandmarkTrack landmarks = follow_face({{"a.png", {face(10, 50)}}}).landmarks;
  EXPECT_EQ(landmarks.landmarks(), 68);
  EXPECT_EQ(landmarks.names.front(), "1");
  EXPECT_EQ(landmarks.names.back(), "68");
  EXPECT_EQ(landmarks.points.cols(), 2 * 68);
}

TEST(FaceTrack, RefusesAConfidenceOutOfRange) {
  EXPECT_THROW(follow_face({}, 1.5), std::invalid_argument);
  EXPECT_THROW(follow_face({}, -0.1), std::invalid_argument);
}

class NamedImages : public testing::Test {
 protected:
  void touch(const std::string& name) { std::ofstream(folder_ / name) << name; }
  std::vector<std::string> names(const std::string& text) {
    std::vector<std::string> result;
    for (const auto& file : image_files(text)) result.push_back(file.filename().string());
    return result;
  }
  std::string path(const std::string& name) { return (folder_ / name).string(); }
  test::TemporaryFolder folder_;
};

TEST_F(NamedImages, OfAFolderAreInNaturalOrder) {
  for (const char* name : {"f10.jpg", "f2.JPG", "f1.jpg", ".f0.jpg", "f1.pts"}) touch(name);
  EXPECT_THAT(names(folder_.path().string()), ElementsAre("f1.jpg", "f2.JPG", "f10.jpg"));
  EXPECT_THAT(names(path("f1*")), ElementsAre("f1.jpg", "f10.jpg"));
  EXPECT_THAT(names(path("f%02d.jpg")), ElementsAre("f10.jpg"));
  EXPECT_THAT(names(path("f1.jpg")), ElementsAre("f1.jpg"));
}

TEST_F(NamedImages, ThatAreMissingAreNamed) {
  touch("a.txt");
  EXPECT_THAT(test::message_of<IoError>([&] { names(folder_.path().string()); }),
              HasSubstr("holds no PNG or JPEG file"));
  EXPECT_THAT(test::message_of<IoError>([&] { names(path("a.png")); }),
              HasSubstr("a.png: no such file or folder"));
  EXPECT_THAT(test::message_of<IoError>([&] { names(path("*.png")); }),
              HasSubstr("matches no PNG or JPEG file"));
}

}  // namespace
}  // namespace mimetra
