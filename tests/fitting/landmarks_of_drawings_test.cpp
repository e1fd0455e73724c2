#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "samples/head/head.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using testing::HasSubstr;

/// The built-in head's landmarks are known.
class LandmarksOfDrawings : public testing::Test {
 protected:
  void SetUp() override { MIMETRA_SKIP_WITHOUT(kDebianFaceModel); }

  static Head sample_head() {
    const BlendshapeModel person = samples::parametric_head().person();
    return {"head", {person.neutral(), person.connectivity()}};
  }
  /// Large enough for faces of 80 pixels.
  static FaceLandmarks found_in(const Head& head) {
    static const LandmarkFinder finder = landmarks_of_drawings();
    return find_landmarks(head, finder, {.pixels = 288});
  }
};

TEST_F(LandmarksOfDrawings, AreWhereTheHeadHasThemHoweverItLiesInWhateverUnit) {
  const Head head = sample_head();
  const FaceLandmarks found = found_in(head);
  std::map<int, VertexIndex> known, upright;
  for (const auto& [number, vertex] : samples::head_landmarks()) known[number - 1] = vertex;
  const Positions& positions = head.mesh.positions;
  double sum = 0, largest = 0;
  for (const FaceLandmark& landmark : found.found) {
    ASSERT_TRUE(known.contains(landmark.number));
    const double off =
        (positions.row(landmark.vertex) - positions.row(known.at(landmark.number))).norm();
    sum += off / found.size;
    largest = std::max(largest, off / found.size);
    upright[landmark.number] = landmark.vertex;
  }
  EXPECT_GE(found.found.size(), 36u);
  EXPECT_GE(found.views_with_face, found.views - 1);
  // On a photograph the detector is 2.8 % of the eyes' distance off; where brows and lips have no
  // colour, twice that, and vertices are 2 % apart.
  EXPECT_LT(sum / double(found.found.size()), 0.08);
  EXPECT_LT(largest, 0.16);
  EXPECT_GT(found.axes(1, 1), 0.95);
  EXPECT_GT(found.axes(2, 2), 0.95);

  Head lying = head;  // on its back
  for (auto row : lying.mesh.positions.rowwise())
    row = Eigen::RowVector3d(row[0], -row[2], row[1]) / 1000;
  const FaceLandmarks there = found_in(lying);
  int same = 0;
  for (const FaceLandmark& landmark : there.found) {
    same += upright.contains(landmark.number) && upright[landmark.number] == landmark.vertex;
  }
  // Rounding may carry a few to the next pixel.
  EXPECT_GE(same, 0.9 * double(upright.size()));
  EXPECT_GT(there.axes(2, 1), -1);
  EXPECT_LT(there.axes(2, 1), -0.95);
}

TEST_F(LandmarksOfDrawings, AreNotOnABall) {
  EXPECT_THAT(message_of<MismatchError>([] {
                found_in({"ball.obj", mesh_of(sphere(4))});
              }),
              HasSubstr("ball.obj: no face was found"));
}

TEST_F(LandmarksOfDrawings, NeedTheModelWhenTheyAreLookedForFirst) {
  TemporaryFolder folder;
  const LandmarkFinder finder = landmarks_of_drawings(folder / "none.dat");
  EXPECT_THAT(message_of<IoError>([&] {
                finder(GreyImage{1, 1, {0}});
              }),
              HasSubstr("libdlib-data"));
}

}  // namespace
}  // namespace mimetra::test
