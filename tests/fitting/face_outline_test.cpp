#include "fitting/face_outline.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/fitting/two_videos.h"

namespace mimetra {
namespace {

/// The built-in head in one frame, seen by the turning camera at `time`.
FittedFrame frame_of_head(const MorphableModel& head, double time) {
  const std::vector<int> vertices = test::vertices_of_landmarks();
  const AffineCamera camera = test::turning_camera(time, 0, 100);
  const ImagePoints image = project(camera, head.mean()(vertices, Eigen::all));
  return {std::make_shared<const LandmarkRows>(head, vertices), image, 1};
}

TEST(FaceOutline, IsAsFarOutAsTheModelIs) {
  const MorphableModel& head = test::built_in_head();
  const FaceOutline outline(head);
  for (const double time : {0.0, 0.4, 1.3}) {
    const FittedFrame frame = frame_of_head(head, time);
    const ImagePoints image = frame.projected(head.mean());
    // Vertices that are the outermost in some direction are on it.
    ImagePoints places(4, 2);
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Index least = 0, most = 0;
      image.col(axis).minCoeff(&least);
      image.col(axis).maxCoeff(&most);
      places.row(2 * axis) = image.row(least);
      places.row(2 * axis + 1) = image.row(most);
    }
    const auto rows = outline.matched(frame, head.mean(), places);
    ASSERT_TRUE(rows);
    // The fitted camera is the true one up to rounding.
    EXPECT_LT((frame.projected(rows->mean) - places).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((rows->normals.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
  }
}

TEST(FaceOutline, LeavesOutWhatIsNotSeen) {
  const MorphableModel& head = test::built_in_head();
  const FaceOutline outline(head);
  const FittedFrame frame = frame_of_head(head, 0);
  ImagePoints places(2, 2);
  places << std::numeric_limits<double>::quiet_NaN(), 0, 10, 10;
  EXPECT_EQ(outline.matched(frame, head.mean(), places)->image.rows(), 1);
  EXPECT_FALSE(outline.matched(frame, head.mean(), places.topRows(1)));
}

TEST(FaceOutline, CountsItsLandmarksAcrossItOnly) {
  const MorphableModel& head = test::built_in_head();
  const FaceOutline outline(head);
  FittedFrame frame = frame_of_head(head, 0);
  const ImagePoints image = frame.projected(head.mean());
  ImagePoints place = image.colwise().mean();
  place(0, 0) = image.col(0).maxCoeff() + 7;
  const auto rows = outline.matched(frame, head.mean(), place);
  const double before = frame.misfit();
  frame.set_outline(rows);
  const double distance = frame.outline_residual()[0];
  // No edge is nearer than the outermost vertex, and the way across is not longer than the whole.
  const double whole = (place - frame.projected(rows->mean)).norm();
  EXPECT_GE(whole, 7 - 1e-6);
  EXPECT_LE(std::abs(distance), whole + 1e-9);
  EXPECT_NEAR(frame.misfit() - before, frame.weight() * distance * distance, 1e-9);
}

}  // namespace
}  // namespace mimetra
