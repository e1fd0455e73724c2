#include "fitting/fit_checks.h"

#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "fitting/landmark_fitter.h"
#include "tests/fitting/two_videos.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct HeadFromAfar {
  const MorphableModel& head = test::built_in_head();
  MappedLandmarks mapped;
  double side = 0;  ///< of the landmarks' box on the head
};

/// The built-in head in three frames, from the front at so many pixels a unit; of the second frame
/// only three landmarks are seen, of the third none.
HeadFromAfar head_at(double scale) {
  HeadFromAfar seen;
  for (const auto& [number, vertex] : samples::head_landmarks()) {
    seen.mapped.vertices.push_back(vertex);
  }
  const Positions points = seen.head.mean()(seen.mapped.vertices, Eigen::all);
  seen.side = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  AffineCamera camera = AffineCamera::Zero();
  camera(0, 0) = scale;
  camera(1, 1) = -scale;
  seen.mapped.points.resize(3, 2 * points.rows());
  seen.mapped.points.rowwise() = test::as_row(project(camera, points));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  seen.mapped.points.row(1).tail(2 * (points.rows() - 3)).setConstant(nan);
  seen.mapped.points.row(2).setConstant(nan);
  return seen;
}

/// What is d away from a camera of focal length f has f / d pixels a unit. The depth of the face
/// counts in its radius, but not in the image: it is somewhat nearer than said.
TEST(CameraDistance, IsThatOfAFaceOfItsSizeInTheImage) {
  constexpr double kScale = 3;
  const HeadFromAfar seen = head_at(kScale);
  for (const double sides : {0.1, 1.0, 8.0}) {
    const double focal_length = kScale * sides * seen.side;
    const double distance = camera_distance(seen.head, seen.mapped, focal_length);
    EXPECT_GE(distance, sides);
    EXPECT_LT(distance, 1.25 * sides);
  }
}

TEST(FocalLength, InMillimetresIsRefusedWithWhatItIsInPixels) {
  const HeadFromAfar seen = head_at(3);
  const auto message = [&](double focal_length) {
    return test::message_of<UsageError>([&] {
      check_focal_length({.focal_length = focal_length}, seen.head, seen.mapped, nullptr);
    });
  };
  EXPECT_THAT(
      message(26),
      AllOf(HasSubstr("--focal-length: 26 pixels put the camera 0.0"),
            HasSubstr("is it in millimetres?"),
            HasSubstr("26 / 36 of the image's longer side: 1387 pixels where that is 1920")));
}

TEST(FocalLength, OfCamerasThatAreFartherThanTheFaceIsLargeIsTaken) {
  const HeadFromAfar seen = head_at(3);
  for (const FitOptions& options :
       {FitOptions{.focal_length = 3 * 1.01 * seen.side}, FitOptions{}}) {
    EXPECT_NO_THROW(check_focal_length(options, seen.head, seen.mapped, nullptr));
  }
}

/// Landmarks of the built-in head in so many frames, all at rest and from the front.
MappedLandmarks still_head(int frames) {
  MappedLandmarks mapped;
  for (const auto& [number, vertex] : samples::head_landmarks()) {
    mapped.names.push_back(std::to_string(number));
    mapped.vertices.push_back(vertex);
    mapped.ibug.emplace_back(number - 1, vertex);
  }
  AffineCamera camera = AffineCamera::Zero();
  camera(0, 0) = 2;
  camera(1, 1) = -2;
  const Positions points = test::built_in_head().mean()(mapped.vertices, Eigen::all);
  mapped.points.resize(frames, 2 * points.rows());
  mapped.points.rowwise() = test::as_row(project(camera, points));
  return mapped;
}

/// Leaves of a frame only the landmarks whose numbers (1 to 68) are `kept`.
template <typename Kept>
void keep(MappedLandmarks& mapped, int frame, Kept kept) {
  for (std::size_t i = 0; i < mapped.ibug.size(); ++i) {
    if (kept(mapped.ibug[i].first + 1)) continue;
    mapped.points.row(frame)
        .segment<2>(2 * Eigen::Index(i))
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

bool is_of_eyes(int number) {
  return number >= 37 && number <= 48;
}

bool is_of_mouth(int number) {
  return number >= 49;
}

/// The half of a face that a profile shows: its own right.
bool is_of_right_half(int number) {
  return number <= 9 || (number >= 18 && number <= 22) || (number >= 28 && number <= 34) ||
         (number >= 37 && number <= 42) || (number >= 49 && number <= 52) || number >= 58;
}

TEST(PartialFrames, AreThoseOfEyesOrMouthOrAFewLandmarksAlone) {
  MappedLandmarks mapped = still_head(8);
  keep(mapped, 1, is_of_eyes);
  keep(mapped, 2, is_of_mouth);
  keep(mapped, 3, [](int number) { return number == 31 || number == 37 || number == 46; });
  keep(mapped, 4, [](int) { return false; });
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), ElementsAre(1, 2, 3));
}

TEST(PartialFrames, AreNotThoseOfAHalfNorOfEverySecondLandmark) {
  MappedLandmarks mapped = still_head(5);
  keep(mapped, 1, is_of_right_half);
  keep(mapped, 2, [](int number) { return !is_of_mouth(number); });
  keep(mapped, 3, [](int number) { return number % 2 == 0; });
  keep(mapped, 4, [](int number) { return !is_of_eyes(number); });
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), IsEmpty());
}

TEST(PartialFrames, AreNoneWhereFewFramesShowMore) {
  MappedLandmarks mapped = still_head(5);
  for (const int frame : {0, 1}) keep(mapped, frame, is_of_eyes);
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), ElementsAre(0, 1));
  for (const int frame : {2, 3}) keep(mapped, frame, is_of_eyes);
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), IsEmpty());
  // Three landmarks make no camera.
  keep(mapped, 1, [](int number) { return number == 37 || number == 40 || number == 46; });
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), ElementsAre(1));
  keep(mapped, 4, is_of_eyes);
  EXPECT_THAT(partial_frames(test::built_in_head(), mapped), IsEmpty());
}

/// The uncertainty is that of the fit: turns that are found for landmarks with its noise spread as
/// it says. Without expressions, whose bounds make them no normal variables.
TEST(TurnUncertainty, IsTheSpreadOfTheTurnsThatAreFound) {
  const MorphableModel& head = test::built_in_head();
  const MorphableModel rigid(head.shared_connectivity(), head.mean(), {}, {});
  const MappedLandmarks mapped = still_head(1);
  std::vector<Eigen::Index> all, right;
  for (std::size_t i = 0; i < mapped.ibug.size(); ++i) {
    all.push_back(Eigen::Index(i));
    if (is_of_right_half(mapped.ibug[i].first + 1)) right.push_back(Eigen::Index(i));
  }
  const TurnUncertainty uncertainty(rigid, mapped.vertices, Eigen::Matrix3d::Identity());
  EXPECT_GT(uncertainty.of(right), uncertainty.of(all));
  std::mt19937 random(5);
  constexpr int kFrames = 400;
  for (const auto& seen : {all, right}) {
    std::vector<int> vertices;
    vertices.reserve(seen.size());
    for (const Eigen::Index i : seen) vertices.push_back(mapped.vertices[std::size_t(i)]);
    const ImagePoints image = points_of_frame(mapped.points, 0);
    const double sigma = kUsualSigma * rms_radius(image);
    Frames points(kFrames, 2 * Eigen::Index(seen.size()));
    for (auto frame : points.rowwise()) {
      frame = test::as_row(image(seen, Eigen::all) +
                           sigma * test::normal_matrix(Eigen::Index(seen.size()), 2, random));
    }
    const std::vector<FrameFit> fits = LandmarkFitter(rigid, vertices)
                                           .fit(points, {.sigma = sigma,
                                                         .camera = FitOptions::Camera::orthographic,
                                                         .outliers = FitOptions::Outliers::trust});
    double squares = 0;
    for (const FrameFit& fit : fits) {
      squares += std::pow(Eigen::AngleAxisd(head_rotation(fit.camera)).angle(), 2);
    }
    // The mean of 400 squares of three normal variables is known to a few percent.
    EXPECT_NEAR(std::sqrt(squares / kFrames) * 180 / std::numbers::pi, uncertainty.of(seen),
                0.1 * uncertainty.of(seen));
  }
}

}  // namespace
}  // namespace mimetra
