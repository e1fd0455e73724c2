#include "fitting/camera_distance.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/fitting/two_videos.h"
#include "tests/temporary_folder.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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

}  // namespace
}  // namespace mimetra
