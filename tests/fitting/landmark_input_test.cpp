#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/landmark_input.h"
#include "tests/option_ranges.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LandmarkInput : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name) << content;
  }
  void write_points(const std::string& name, double x) {
    write(name, "version: 1\nn_points: 1\n{\n" + std::to_string(x) + " 2\n}\n");
  }
  std::vector<std::string> images(const LandmarksRead& read) {
    std::vector<std::string> names;
    for (int f = 0; read.images && f < read.images->frames(); ++f) {
      names.push_back(std::filesystem::path(read.images->name(f)).filename().string());
    }
    return names;
  }
  LandmarksRead read(const std::string& name, const ReadOptions& reading = {},
                     const LandmarkInputOptions& options = {}) {
    return read_landmark_input((folder_ / name).string(), reading, options);
  }
  std::string path(const std::string& name) { return (folder_ / name).string(); }
  test::TemporaryFolder folder_;
};

TEST_F(LandmarkInput, OfLittleConfidenceIsTakenAsNotSeen) {
  write("t.csv", "confidence,x0,y0\n0.9,1,2\n0.05,3,4\n0.1,5,6\n");
  const LandmarksRead read = this->read("t.csv");
  EXPECT_EQ(read.track.points(0, 0), 1);
  EXPECT_TRUE(read.track.points.row(1).array().isNaN().all());
  EXPECT_EQ(read.track.points(2, 0), 5);
  EXPECT_THAT(read.frame_notes, ElementsAre("", "confidence 0.05 is below 0.1", ""));
  EXPECT_THAT(read.notes, ElementsAre(AllOf(HasSubstr("t.csv: 1 of 3 frames"),
                                            HasSubstr("taken as not seen"))));
  EXPECT_THAT(this->read("t.csv", {}, {.faces = {.min_confidence = 0}}).notes, IsEmpty());
}

TEST_F(LandmarkInput, RefusesOptionsOutOfRange) {
  write("t.csv", "x0,y0\n1,2\n");
  test::expect_ranges<FaceOptions>();
  EXPECT_THROW(read("t.csv", {}, {.faces = {.min_confidence = 2}}), std::invalid_argument);
  EXPECT_THROW(read("t.csv", {.fps = 0}), std::invalid_argument);
}

TEST_F(LandmarkInput, RefusesAFaceModelWhereNoFaceIsLookedFor) {
  write("t.csv", "x0,y0\n1,2\n");
  EXPECT_THAT(test::message_of<MismatchError>(
                  [&] { read("t.csv", {}, {.faces = {.model = kDebianFaceModel}}); }),
              HasSubstr("option 'face-model': "));
}

TEST_F(LandmarkInput, HasTheImagesBesidePoints) {
  for (const char* name : {"10", "9"}) {
    write_points(std::string(name) + ".pts", 1);
    write(std::string(name) + ".jpg", "");
  }
  EXPECT_THAT(images(read("*.pts")), ElementsAre("9.jpg", "10.jpg"));
  EXPECT_THAT(images(read("", {.frames = "1:"})), ElementsAre("10.jpg"));
  EXPECT_THAT(images(read("9.pts")), ElementsAre("9.jpg"));
  write("9.JPEG", "");
  write("9.png", "");
  EXPECT_THAT(images(read("9.pts")), ElementsAre("9.JPEG"));
  for (const char* other : {"9.JPEG", "9.png"}) std::filesystem::remove(folder_ / other);
  std::filesystem::remove(folder_ / "9.jpg");
  EXPECT_THAT(images(read("*.pts")), IsEmpty());
}

TEST_F(LandmarkInput, TakesTheImagesThatAreNamedForTheWholeClip) {
  write("t.csv", "x0,y0\n1,2\n3,4\n5,6\n");
  for (const char* name : {"1.png", "2.png", "3.png"}) write(name, "");
  LandmarkInputOptions options{.images = path("*.png")};
  EXPECT_THAT(images(read("t.csv", {}, options)), ElementsAre("1.png", "2.png", "3.png"));
  EXPECT_THAT(images(read("t.csv", {.frames = "::2"}, options)), ElementsAre("1.png", "3.png"));
  options.images = path("1.png");
  EXPECT_THAT(test::message_of<MismatchError>([&] { read("t.csv", {}, options); }),
              HasSubstr("1.png: 1 images, expected one for each of the 3 frames"));
}

TEST_F(LandmarkInput, KeepsTheTimeOfTheWholeClip) {
  write("t.csv", "x0,y0\n1,2\n3,4\n5,6\n");
  const LandmarksRead read = this->read("t.csv", {.frames = "1::1", .fps = 10});
  EXPECT_THAT(std::vector(read.track.times.begin(), read.track.times.end()),
              ElementsAre(testing::DoubleEq(0.1), testing::DoubleEq(0.2)));
}

/// 468 landmarks, all in the middle of a quarter of the image.
std::string quarter_of_an_image() {
  std::string points;
  for (int i = 0; i < 468; ++i) points += std::string(i > 0 ? ", " : "") + "[0.25, 0.5, 0]";
  return "[[" + points + "]]";
}

TEST_F(LandmarkInput, InSharesAreKnownByTheirRange) {
  // Six landmarks that nobody numbers as MediaPipe does.
  const std::string names = "x0,y0,x1,y1,x2,y2,x3,y3,x4,y4,x5,y5\n";
  write("s.csv", names + "0.25,0.5,0.3,0.5,0.35,0.5,0.4,0.5,0.5,0.6,1.01,0.9\n");
  const LandmarksRead read = this->read("s.csv", {}, {.image_size = "1920x1080"});
  EXPECT_EQ(read.track.points(0, 0), 479.5);
  EXPECT_EQ(read.track.points(0, 1), 539.5);
  EXPECT_THAT(test::message_of<MismatchError>([&] { this->read("s.csv"); }),
              AllOf(HasSubstr("in shares"), HasSubstr("option 'image-size'")));
  write("p.csv", names + "0.25,0.5,0.3,0.5,0.35,0.5,0.4,0.5,0.5,0.6,3,0.9\n");
  EXPECT_EQ(this->read("p.csv").track.points(0, 0), 0.25);
}

TEST_F(LandmarkInput, InSharesIsKnownAlthoughOneIsFoundWrong) {
  std::string rows = "x0,y0,x1,y1,x2,y2,x3,y3,x4,y4\n0.25,0.5,0.3,0.5,0.35,0.5,0.4,0.5,2.4,0.6\n";
  for (int f = 1; f < 3; ++f) rows += "0.25,0.5,0.3,0.5,0.35,0.5,0.4,0.5,0.5,0.6\n";
  write("s.csv", rows);
  const LandmarksRead read = this->read("s.csv", {}, {.image_size = "640x480"});
  EXPECT_EQ(read.track.points(1, 0), 159.5);
  EXPECT_THAT(test::message_of<MismatchError>([&] { this->read("s.csv"); }),
              HasSubstr("at least nine in ten have no coordinate above 2"));
}

TEST_F(LandmarkInput, InSharesBecomesPixelsOfTheImageWhoseSizeItNeeds) {
  write("m.json", quarter_of_an_image());
  const LandmarksRead pixels = read("m.json", {}, {.image_size = "1920x1080"});
  EXPECT_EQ(pixels.track.points(0, 0), 479.5);
  EXPECT_EQ(pixels.track.points(0, 1), 539.5);
  EXPECT_THAT(test::message_of<MismatchError>([&] { read("m.json"); }),
              AllOf(HasSubstr("in shares"), HasSubstr("option 'image-size'")));
  for (const std::string size : {"", "1920", "1920x", "x1080", "1920x1080x3", "0x5", "-3x4"}) {
    EXPECT_THROW(read("m.json", {}, {.image_size = size}), std::invalid_argument) << size;
  }
  write("t.csv", "x0,y0\n100,200\n");
  EXPECT_THAT(
      test::message_of<MismatchError>([&] { read("t.csv", {}, {.image_size = "1920x1080"}); }),
      HasSubstr("in pixels already"));
}

/// Five landmarks around (320, 240), the rows of two frames.
constexpr const char* kFiveNames = "x0,y0,x1,y1,x2,y2,x3,y3,x4,y4\n";
constexpr const char* kFiveSeen = "300,200,340,200,320,240,300,280,340,280\n";

TEST_F(LandmarkInput, TakesPlaceholdersOutsideOfTheFaceAsNotSeen) {
  write("t.csv", std::string(kFiveNames) + kFiveSeen + "300,200,0,0,320,240,-1,-1,340,280\n" +
                     "0,0,0,0,0,0,0,0,0,0\n" + "-1,-1,-1,-1,-1,-1,-1,-1,-1,-1\n");
  const LandmarksRead read = this->read("t.csv");
  const auto unseen = [&read](int frame) {
    return read.track.points.row(frame).array().isNaN().count();
  };
  EXPECT_EQ(unseen(0), 0);
  EXPECT_EQ(unseen(1), 4);
  EXPECT_EQ(read.track.points(1, 4), 320);
  EXPECT_EQ(unseen(2), 10);
  EXPECT_EQ(unseen(3), 10);
  EXPECT_THAT(read.notes, ElementsAre(AllOf(HasSubstr("t.csv: 3 of 4 frames have landmarks at"),
                                            HasSubstr("; 2 of them have no others"))));
}

TEST_F(LandmarkInput, KeepsALandmarkThatIsTheOriginOfTheFace) {
  write("t.csv", std::string(kFiveNames) + "-20,-40,20,-40,0,0,-20,40,20,40\n");
  const LandmarksRead read = this->read("t.csv");
  EXPECT_FALSE(read.track.points.array().isNaN().any());
  EXPECT_THAT(read.notes, IsEmpty());
}

TEST_F(LandmarkInput, NamesNumbersThatNoFileOfPointsHas) {
  for (const char* number : {"1", "2", "5", "6"}) write_points(std::string(number) + ".pts", 1);
  EXPECT_THAT(read("").notes, ElementsAre(HasSubstr("no file has these numbers: 3 to 4")));
}

TEST_F(LandmarkInput, SaysThatTimesLookLikeMilliseconds) {
  write("t.csv", "time,x0,y0\n0,1,2\n33,1,2\n67,1,2\n");
  EXPECT_THAT(read("t.csv").notes, ElementsAre(HasSubstr("t.csv: its frames are 34 s apart")));
}

}  // namespace
}  // namespace mimetra
