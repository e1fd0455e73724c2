#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "fitting/landmark_input.h"
#include "fitting/video_file.h"
#include "tests/fitting/drawn_head.h"
#include "tests/fitting/made_video.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// Images that were drawn, as a recording or as pictures that have nothing to do with each other.
class DrawnImages final : public ImageSequence {
 public:
  DrawnImages(std::vector<Image> images, bool is_recording)
      : images_(std::move(images)), is_recording_(is_recording) {}

  int frames() const override { return static_cast<int>(images_.size()); }
  Image image(int frame) const override { return images_.at(static_cast<std::size_t>(frame)); }
  std::string name(int frame) const override { return "drawn " + std::to_string(frame); }
  bool is_recording() const override { return is_recording_; }
  void check() const override {}

 private:
  std::vector<Image> images_;
  bool is_recording_;
};

/// A head that turns, nears and moves through the picture while it talks.
std::vector<Image> talking_head(int frames, int width = 480, int height = 360) {
  const WeightTrack track = samples::parametric_performance();
  std::vector<Image> images;
  for (int f = 0; f < frames; ++f) {
    const double phase = 0.1 * f;
    images.push_back(drawn_head(width, height,
                                {.x = 0.5 * width + 60 * std::sin(phase),
                                 .y = 0.5 * height + 20 * std::cos(1.3 * phase),
                                 .height = 0.6 * height + 0.1 * height * std::sin(0.7 * phase),
                                 .yaw = 12 * std::sin(0.5 * phase)},
                                track.weights.row(f % track.weights.rows())));
  }
  return images;
}

/// Median of the mean distance of landmarks over the frames that both have.
double landmark_distance(const LandmarkTrack& a, const LandmarkTrack& b) {
  std::vector<double> means;
  for (Eigen::Index f = 0; f < a.points.rows(); ++f) {
    const Eigen::RowVectorXd between = a.points.row(f) - b.points.row(f);
    const double mean = between.reshaped(2, between.size() / 2).colwise().norm().mean();
    if (!std::isnan(mean)) means.push_back(mean);
  }
  std::ranges::nth_element(means, means.begin() + std::ssize(means) / 2);
  return means.at(means.size() / 2);
}

/// Frames without landmarks have NaN, which is not equal to itself.
bool same_bytes(const Frames& a, const Frames& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}

class VideoTrack : public testing::Test {
 protected:
  void SetUp() override { MIMETRA_SKIP_WITHOUT(kDebianFaceModel); }
  std::string written(const std::string& name, const std::vector<Image>& images) {
    write_video(folder_ / name, images, even_times(static_cast<int>(images.size())));
    return folder_ / name;
  }
  static std::vector<int> seen(const LandmarkTrack& track) {
    std::vector<int> frames;
    for (int f = 0; f < track.frames(); ++f) {
      if (track.confidence[f] > 0) frames.push_back(f);
    }
    return frames;
  }
  static std::vector<int> all_but(int frames, int first, int last) {
    std::vector<int> rest;
    for (int f = 0; f < frames; ++f) {
      if (f < first || f >= last) rest.push_back(f);
    }
    return rest;
  }
  TemporaryFolder folder_;
};

/// A face that leaves meanwhile, in more frames than one thread searches at a time.
TEST_F(VideoTrack, FindsWhatASearchOfEveryFrameFindsOnAnyNumberOfThreads) {
  std::vector<Image> images = talking_head(33, 320, 240);
  std::fill(images.begin() + 10, images.begin() + 20, Image(320, 240, {90, 100, 110}));
  const FaceTrack near = track_face(DrawnImages(images, true), {}, Context().with_threads(1));
  EXPECT_EQ(seen(near.landmarks), all_but(33, 10, 20));
  EXPECT_THAT(near.notes, testing::Contains(HasSubstr("10 of 33 images show no face")));

  const FaceTrack everywhere = track_face(DrawnImages(images, false));
  EXPECT_EQ(seen(near.landmarks), seen(everywhere.landmarks));
  const double distance = landmark_distance(near.landmarks, everywhere.landmarks);
  RecordProperty("distance", std::to_string(distance));
  EXPECT_LT(distance, 0.5);

  const FaceTrack several = track_face(DrawnImages(images, true), {}, Context().with_threads(3));
  EXPECT_TRUE(same_bytes(near.landmarks.points, several.landmarks.points));
  EXPECT_EQ(near.landmarks.confidence, several.landmarks.confidence);
}

TEST_F(VideoTrack, HasTheTimesOfTheFrames) {
  const std::vector<double> uneven = {0, 0.05, 0.1, 0.3, 0.35};
  std::vector<Image> images = talking_head(5);
  images[3] = Image(images[3].width, images[3].height, {90, 100, 110});
  write_video(folder_ / "v.mp4", images, uneven);
  const LandmarksRead read = read_landmark_input(folder_ / "v.mp4", {.frames = "1::2"});
  ASSERT_EQ(read.track.frames(), 2);
  EXPECT_NEAR(read.track.times[0], 0.05, 1e-4);
  EXPECT_NEAR(read.track.times[1], 0.3, 1e-4);
  ASSERT_EQ(read.frame_notes.size(), 2u);
  EXPECT_EQ(read.frame_notes[1], "no face found");
  EXPECT_THAT(read.files, ElementsAre(folder_ / "v.mp4"));
  ASSERT_TRUE(read.images);
  EXPECT_EQ(read.images->frames(), 2);
  EXPECT_THAT(read.images->name(1), HasSubstr("v.mp4, frame 3"));
  EXPECT_THAT(message_of<std::invalid_argument>(
                  [&] { read_landmark_input(folder_ / "v.mp4", {.fps = 30}); }),
              AllOf(HasSubstr("5 frames have times of their own"), HasSubstr("'fps'")));
}

TEST_F(VideoTrack, WithoutAFaceIsAnError) {
  const std::vector<Image> images(2, Image(320, 240, {90, 100, 110}));
  EXPECT_THAT(message_of<IoError>([&] { read_landmark_input(written("v.mp4", images)); }),
              AllOf(HasSubstr("v.mp4"), HasSubstr("shows no face"), HasSubstr("other 1")));
}

TEST_F(VideoTrack, OfTwoFacesFollowsTheLargerOne) {
  const BlendshapeModel person = samples::parametric_head().person();
  std::vector<Image> images;
  for (int f = 0; f < 32; ++f) {
    // The smaller one grows beyond the other, which it does not pass.
    Image image = drawn_head(640, 360, {.x = 180 + 2.0 * f, .y = 180, .height = 240});
    draw_head(person.neutral(), person.connectivity().triangles,
              {.x = 500, .y = 180, .height = 180 + 4.0 * f}, image);
    images.push_back(image);
  }
  const LandmarksRead read = read_landmark_input(written("v.mp4", images));
  ASSERT_EQ(seen(read.track).size(), 32u);
  for (int f = 0; f < 32; ++f) EXPECT_NEAR(read.track.points(f, 2 * 30), 180 + 2.0 * f, 40);
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("show several faces")));
}

TEST_F(VideoTrack, ThatBreaksOffIsAnErrorUnlessOnlySoundFramesAreTaken) {
  const std::string whole = written("v.mkv", talking_head(20, 320, 240));
  std::filesystem::resize_file(whole, std::filesystem::file_size(whole) / 2);
  const int sound = VideoFile(whole).frames();
  ASSERT_GT(sound, 2);
  const std::string advice = "'frames' 0:" + std::to_string(sound);
  EXPECT_THAT(message_of<IoError>([&] { read_landmark_input(whole); }),
              AllOf(StartsWith(whole), HasSubstr(advice)));
  EXPECT_THAT(message_of<IoError>([&] { read_landmark_input(whole, {.frames = "0:20"}); }),
              HasSubstr(advice));
  EXPECT_EQ(read_landmark_input(whole, {.frames = "0:2"}).track.frames(), 2);
}

TEST_F(VideoTrack, CanBeCancelled) {
  const DrawnImages images(std::vector<Image>(40, talking_head(1, 320, 240).front()), true);
  for (const int threads : {1, 2}) {
    const Context context =
        Context().with_threads(threads).with_progress([](double) { return false; });
    EXPECT_THROW(track_face(images, {}, context), Cancelled);
  }
}

TEST_F(VideoTrack, LendsItsFramesToLandmarksFromElsewhere) {
  const std::string video = written("v.mp4", talking_head(3));
  std::ofstream(folder_ / "t.csv") << "x0,y0\n1,2\n3,4\n5,6\n";
  const LandmarksRead read = read_landmark_input(folder_ / "t.csv", {}, {.images = video});
  ASSERT_TRUE(read.images);
  EXPECT_EQ(read.images->image(2).width, 480);
  std::ofstream(folder_ / "t.csv") << "x0,y0\n1,2\n";
  EXPECT_THAT(message_of<MismatchError>(
                  [&] { read_landmark_input(folder_ / "t.csv", {}, {.images = video}); }),
              HasSubstr("v.mp4: 3 images, expected one for each of the 1 frames"));
}

}  // namespace
}  // namespace mimetra::test
