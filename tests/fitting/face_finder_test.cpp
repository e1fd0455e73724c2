#include <cmath>
#include <fstream>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "fitting/landmark_file.h"
#include "fitting/landmark_fitter.h"
#include "fitting/landmark_mapping.h"
#include "tests/fitting/saved_image.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Image noise(int width, int height) {
  std::mt19937 random(1);
  const auto channel = [&] { return static_cast<std::uint8_t>(random() % 256); };
  Image image(width, height);
  for (Color& color : image.pixels) color = {channel(), channel(), channel()};
  return image;
}

double mean_distance(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); i += 2) sum += (a - b).segment<2>(i).norm();
  const Eigen::Index points = a.size() / 2;
  return sum / double(points);
}

/// Copies `source` into `target` with its left upper corner at (left, top).
void paste(const Image& source, int left, int top, Image& target) {
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) target.at(left + x, top + y) = source.at(x, y);
  }
}

class FaceModel : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(FaceModel, ThatIsMissingNamesItsPackageAndOfAnotherKindIsRefused) {
  EXPECT_THAT(message_of<IoError>([&] { FaceFinder(folder_ / "none.dat"); }),
              AllOf(StartsWith((folder_ / "none.dat").string()), HasSubstr("libdlib-data")));
  std::ofstream(folder_ / "other.dat") << "not a predictor";
  EXPECT_THAT(
      message_of<IoError>([&] { FaceFinder(folder_ / "other.dat"); }),
      AllOf(StartsWith((folder_ / "other.dat").string()), HasSubstr("no shape predictor of dlib")));
}

class FaceImages : public FaceModel {
 protected:
  void SetUp() override {
    MIMETRA_SKIP_WITHOUT(shared_path("data/sfm/image_0010.png"));
    MIMETRA_SKIP_WITHOUT(kDebianFaceModel);
    photo_ = shared_path("data/sfm/image_0010.png");
  }
  /// The face and a little around it.
  Image head() const { return cropped(read_image(photo_), 560, 60, 460, 500); }
  std::string written(const Image& image, const std::string& name) {
    save_png(image, folder_ / name);
    return (folder_ / name).string();
  }
  std::filesystem::path photo_;
};

TEST_F(FaceImages, HaveLandmarksWhereAPersonMarkedThem) {
  const FaceTrack track = track_face(ImageFiles({photo_}));
  const LandmarkTrack marked = read_landmarks(shared_path("data/sfm/image_0010.pts"));
  ASSERT_EQ(track.frames.front().outcome, FaceFrame::Outcome::found);
  EXPECT_EQ(track.landmarks.names, marked.names);
  const double between_eyes =
      (marked.points.row(0).segment<2>(2 * 36) - marked.points.row(0).segment<2>(2 * 45)).norm();
  // The method's authors report a mean error of 4.9 % of the distance between the eyes; a sharp
  // face that looks into the camera must not be worse than their mean.
  const double distance = mean_distance(track.landmarks.points.row(0), marked.points.row(0));
  RecordProperty("distance", std::to_string(distance));
  RecordProperty("between_eyes", std::to_string(between_eyes));
  EXPECT_LT(distance, 0.049 * between_eyes);
  EXPECT_THAT(track.notes, testing::ElementsAre(HasSubstr("non-commercial")));
}

TEST_F(FaceImages, FitAtLeastAsWellAsMarkedOnes) {
  const auto folder = shared_path("data/sfm");
  const LandmarkMapping mapping = read_landmark_mapping(find_landmark_mapping(folder));
  const MorphableModel model = read_model(folder);
  const auto rms = [&](const LandmarkTrack& track, FitOptions::Solver solver, int iterations) {
    const MappedLandmarks mapped = map_landmarks(track, mapping);
    return LandmarkFitter(model, mapped.vertices)
        .fit(mapped.points,
             {.solver = solver, .iterations = iterations, .tolerance = 0, .sigma = std::sqrt(3.0)})
        .front()
        .rms;
  };
  const LandmarkTrack found = track_face(ImageFiles({photo_})).landmarks;
  const LandmarkTrack marked = read_landmarks(folder / "image_0010.pts");
  for (const auto& [name, solver] : {std::pair("alternating", FitOptions::Solver::alternating),
                                     std::pair("joint", FitOptions::Solver::joint)}) {
    for (const int iterations : {5, 20}) {
      const double of_found = rms(found, solver, iterations);
      const double of_marked = rms(marked, solver, iterations);
      const std::string run = std::string(name) + "_" + std::to_string(iterations);
      RecordProperty(run + "_found", std::to_string(of_found));
      RecordProperty(run + "_marked", std::to_string(of_marked));
      // A detector's landmarks are more like a mean face's than a person's are.
      EXPECT_LT(of_found, of_marked) << run;
    }
  }
}

TEST_F(FaceImages, OfAFaceAtTwoSizesGiveTheLargerOneOrTheNearer) {
  const Image large = head(), small = scaled_to_height(large, 250);
  Image both(large.width + small.width, large.height, {120, 120, 120});
  paste(small, 0, 100, both);
  paste(large, small.width, 0, both);
  const std::string two = written(both, "2.png");
  Image one(both.width, both.height, {120, 120, 120});
  paste(small, 0, 100, one);
  const std::string first = written(one, "1.png");
  const auto nose = [](const FaceTrack& track, Eigen::Index frame) {
    return track.landmarks.points(frame, 2 * 30);
  };
  const FaceTrack largest = track_face(ImageFiles({two}));
  EXPECT_EQ(largest.frames[0].faces, 2);
  EXPECT_GT(nose(largest, 0), small.width);
  const FaceTrack nearest = track_face(ImageFiles({first, two}));
  EXPECT_EQ(nearest.frames[0].faces, 1);
  EXPECT_EQ(nearest.frames[1].faces, 2);
  EXPECT_LT(nose(nearest, 1), small.width);
}

TEST_F(FaceImages, OfNoiseOrBelowTheConfidenceAskedForShowNoFace) {
  const std::string nothing = written(noise(320, 240), "noise.png");
  const std::string face = written(head(), "face.png");
  const FaceTrack track = track_face(ImageFiles({nothing, face}));
  EXPECT_EQ(track.frames[0].outcome, FaceFrame::Outcome::no_face);
  EXPECT_EQ(track.frames[1].outcome, FaceFrame::Outcome::found);
  EXPECT_TRUE(track.landmarks.points.row(0).array().isNaN().all());
  EXPECT_THAT(message_of<IoError>([&] {
                track_face(ImageFiles({nothing, nothing}));
              }),
              AllOf(StartsWith(nothing), HasSubstr("shows no face"),
                    HasSubstr("nor does any of the other 1")));
  EXPECT_THAT(
      message_of<IoError>([&] { track_face(ImageFiles({face}), {.min_confidence = 0.99}); }),
      HasSubstr("shows no face that the detector is sure of"));
}

TEST_F(FaceImages, CanBeCancelled) {
  EXPECT_THROW(track_face(ImageFiles({photo_, photo_}), {},
                          Context().with_progress([](double share) { return share == 0; })),
               Cancelled);
}

}  // namespace
}  // namespace mimetra::test
