// Finders that know what they are asked; real ones are tested with the module that has them.

#include "toolkit/correspondence/face_landmarks.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"
#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

/// A face of iBUG's layout, in units of the distance between its eyes, x to the right and y up.
Eigen::Vector2d layout(int landmark) {
  const auto around = [&](double x, double y, double width, double height, int first, int count) {
    const double angle = EIGEN_PI - 2 * EIGEN_PI * (landmark - first) / count;
    return Eigen::Vector2d(x + width * std::cos(angle), y + height * std::sin(angle));
  };
  if (landmark < 17) {
    const double angle = EIGEN_PI * (1 + landmark / 16.0);
    return {1.1 * std::cos(angle), 0.2 + 1.3 * std::sin(angle)};
  }
  if (landmark < 22) return {-0.8 + 0.15 * (landmark - 17), 0.4};
  if (landmark < 27) return {0.2 + 0.15 * (landmark - 22), 0.4};
  if (landmark < 31) return {0, 0.25 - 0.15 * (landmark - 27)};
  if (landmark < 36) return {0.1 * (landmark - 33), -0.3};
  if (landmark < 42) return around(-0.5, 0.2, 0.2, 0.08, 36, 6);
  if (landmark < 48) return around(0.5, 0.2, 0.2, 0.08, 42, 6);
  if (landmark < 60) return around(0, -0.6, 0.35, 0.12, 48, 12);
  return around(0, -0.6, 0.25, 0.05, 60, 8);
}

/// A cap of a sphere with a face's landmarks on it, seen along z.
class KnownFace : public testing::Test {
 protected:
  KnownFace() : head_{"ball.obj", test::mesh_of(test::sphere(4))} {}

  static Vector3d place(int landmark) {
    const Eigen::Vector2d at = 0.4 * layout(landmark);
    return {at.x(), at.y(), std::sqrt(1 - at.squaredNorm())};
  }

  /// Where those are in a view's drawing.
  static LandmarkFinder projections(const MeshView& view) {
    return [view](const GreyImage& image) {
      FoundFace face;
      face.confidence = 0.5;
      const double scale = image.width / view.side, middle = (image.width - 1) / 2.0;
      for (int i = 0; i < kFaceLandmarks; ++i) {
        const Vector3d seen = view.axes * (place(i) - view.centre) * scale;
        face.landmarks.row(i) << middle + seen.x(), middle - seen.y();
      }
      return std::optional(face);
    };
  }

  /// The same pixels of every drawing, as of a thing that looks like a face from one side.
  static LandmarkFinder pixels_of_all() {
    return [](const GreyImage& image) {
      FoundFace face;
      face.confidence = 0.5;
      for (int i = 0; i < kFaceLandmarks; ++i) {
        const Eigen::Vector2d at = layout(i) * image.width / 4;
        face.landmarks.row(i) << image.width / 2.0 + at.x(), image.width / 2.0 - at.y();
      }
      return std::optional(face);
    };
  }

  /// From the front, so that the ball fills the drawing.
  static MeshView front_view() {
    MeshView view;
    view.pixels = 100;
    view.side = 2.4;
    return view;
  }

  Head head_;
};

TEST_F(KnownFace, IsCarriedBackToAPixel) {
  const MeshPainter painter(head_.mesh);
  MeshView view = front_view();
  for (const double turn : {-0.2, 0.0, 0.25}) {
    view.axes = Eigen::AngleAxisd(turn, Vector3d::UnitY()).toRotationMatrix();
    const auto seen = seen_face(painter, view, projections(view), [](int) { return true; });
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->confidence, 0.5);
    for (int i = 17; i < kFaceLandmarks; ++i) {
      ASSERT_TRUE(seen->points[i]);
      const Vector3d off = view.axes * (seen->points[i]->position - place(i));
      // Half a pixel along each side of the drawing; the sphere's triangles are 1 / 250 flat.
      EXPECT_LT(off.head<2>().cwiseAbs().maxCoeff(), 0.5 * view.side / view.pixels + 0.004) << i;
    }
  }
}

TEST_F(KnownFace, IsCarriedBackToWantedTrianglesOnly) {
  const MeshPainter painter(head_.mesh);
  MeshView view = front_view();
  const auto upper = [&](int t) {
    return head_.mesh.positions(head_.mesh.connectivity.triangles(t, 0), 1) > 0;
  };
  const auto seen = seen_face(painter, view, projections(view), upper);
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->points[17]);
  EXPECT_FALSE(seen->points[57]);  // the lower lip
}

TEST_F(KnownFace, HasItsOwnAxes) {
  const MeshPainter painter(head_.mesh);
  MeshView view = front_view();
  const auto front =
      face_place(*seen_face(painter, view, projections(view), [](int) { return true; }));
  ASSERT_TRUE(front);
  EXPECT_NEAR(front->axes.determinant(), 1, 1e-12);
  // Half a pixel of 0.024 over eyes 0.4 apart.
  EXPECT_GT(front->axes(0, 0), 1 - 5e-3);
  EXPECT_GT(front->axes(2, 2), 0.9);
  EXPECT_NEAR(front->middle.x(), 0, 0.024);
}

TEST_F(KnownFace, OnTheInsideOfAMaskIsNone) {
  const MeshPainter painter(head_.mesh);
  MeshView view = front_view();
  auto seen = *seen_face(painter, view, projections(view), [](int) { return true; });
  for (auto& point : seen.points) point->position.z() *= -1;
  EXPECT_FALSE(face_place(seen));
}

TEST_F(KnownFace, ThatIsNoneInNearerViewsIsRefused) {
  const LandmarkFinder from_afar = [all = pixels_of_all()](const GreyImage& image) {
    return image.width < 90 ? all(image) : std::nullopt;
  };
  EXPECT_THAT([&] { find_landmarks(head_, from_afar, {.pixels = 96}); },
              ThrowsMessage<MismatchError>(
                  AllOf(StartsWith("ball.obj: what looks like a face from one side does not from "
                                   "others"),
                        HasSubstr("pair vertices of both heads by hand"))));
}

TEST_F(KnownFace, LosesLandmarksOnWhichViewsDisagree) {
  // The middle of the lower lip is at one of five places, whatever is drawn.
  const LandmarkFinder doubtful = [all = pixels_of_all()](const GreyImage& image) {
    std::optional<FoundFace> face = all(image);
    unsigned hash = 0;
    for (const std::uint8_t pixel : image.pixels) hash = 31 * hash + pixel;
    face->landmarks(57, 0) += 0.08 * (hash / 7 % 5) * image.width;
    return face;
  };
  const FaceLandmarks found = find_landmarks(head_, doubtful, {.pixels = 96});
  std::vector<int> numbers;
  for (const FaceLandmark& landmark : found.found) numbers.push_back(landmark.number);
  EXPECT_THAT(numbers, AllOf(testing::Contains(27), testing::Not(testing::Contains(57)),
                             testing::Not(testing::Contains(62))));
  EXPECT_EQ(found.views_with_face, found.views);
  const std::vector<FaceLandmark> one =
      find_landmarks(head_, doubtful, {.pixels = 96}, Context().with_threads(1)).found;
  ASSERT_EQ(one.size(), found.found.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].vertex, found.found[i].vertex);
    EXPECT_EQ(one[i].place, found.found[i].place);
  }
}

TEST_F(KnownFace, WithoutCornersOfItsEyesOnTheSkinIsNotFound) {
  const LandmarkFinder off = [all = pixels_of_all()](const GreyImage& image) {
    std::optional<FoundFace> face = all(image);
    for (const int corner : {36, 39, 42, 45}) face->landmarks.row(corner).setZero();
    return face;
  };
  EXPECT_THROW(find_landmarks(head_, off, {.pixels = 96}), MismatchError);
}

TEST_F(KnownFace, HasMarkersThatLieAlikeBesideItsLandmarks) {
  // The finer ball has the coarse one's vertices first, and others nearer to the landmarks.
  const Head fine = {"fine.obj", test::mesh_of(test::sphere(5))};
  const AutomaticMarkers found = automatic_markers(head_, fine, pixels_of_all(), {.pixels = 96});
  const auto same = std::ranges::count_if(
      found.markers, [](const Marker& marker) { return marker.source == marker.target; });
  EXPECT_GE(found.markers.size(), 20u);
  EXPECT_GE(static_cast<double>(same), 0.8 * static_cast<double>(found.markers.size()));
}

TEST_F(KnownFace, ThatIsNotFoundOrCannotBeIsAnErrorThatSaysWhatToDo) {
  const LandmarkFinder none = [](const GreyImage&) { return std::optional<FoundFace>(); };
  const auto says = [](const char* start) {
    return ThrowsMessage<MismatchError>(
        AllOf(StartsWith(start), HasSubstr("pair vertices of both heads by hand")));
  };
  EXPECT_THAT([&] { find_landmarks(head_, none, {.pixels = 96}); },
              says("ball.obj: no face was found"));
  EXPECT_THAT([&] { find_landmarks(head_, {}); }, says("ball.obj: this program cannot find faces"));
}

TEST_F(KnownFace, CanBeCancelledAndNeedsASpreadInItsRange) {
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(find_landmarks(head_, pixels_of_all(), {}, cancelled), Cancelled);
  EXPECT_THROW(find_landmarks(head_, pixels_of_all(), {.max_spread = -1}), std::invalid_argument);
}

Head known(LandmarkVertices landmarks) {
  return {"known.obj", test::mesh_of(test::sphere(1)), std::move(landmarks)};
}

TEST(KnownLandmarks, ArePairedByTheirNumbersWithoutAFinder) {
  const Head source = known({{30, 4}, {36, 0}, {45, 1}, {8, 2}, {48, 7}});
  const Head target = known({{45, 11}, {36, 10}, {8, 12}, {54, 3}, {30, 5}});
  const AutomaticMarkers found = automatic_markers(source, target, {});
  EXPECT_EQ(found.markers, (std::vector<Marker>{{2, 12}, {4, 5}, {0, 10}, {1, 11}}));
  EXPECT_EQ(found.landmarks, (std::vector<int>{8, 30, 36, 45}));
  EXPECT_EQ(found.source.views, 0);
  EXPECT_THAT(found.summary("a", "b"),
              testing::ElementsAre("4 markers", "5 landmarks of a were known",
                                   "5 landmarks of b were known"));
  EXPECT_THAT(found.warnings(), testing::Contains(HasSubstr("only 4 markers")));
}

TEST(KnownLandmarks, OfOneHeadOnlyDoNotCount) {
  Head source = known({{30, 4}, {36, 0}, {45, 1}, {8, 2}}), target = known({});
  target.name = "other.obj";
  EXPECT_THAT([&] { automatic_markers(source, target, {}); },
              ThrowsMessage<MismatchError>(HasSubstr("known.obj: this program cannot find faces")));
}

TEST(KnownLandmarks, AreVerticesOfTheMesh) {
  EXPECT_THAT(
      [] {
        find_landmarks(known({{8, 18}}), {});
      },
      ThrowsMessage<MismatchError>(HasSubstr(
          "known.obj: landmark 9 is said to be vertex 18, the mesh has vertices 0 to 17")));
}

TEST(KnownLandmarks, ThatFewHeadsShareAreNoMarkers) {
  EXPECT_THAT(
      [] {
        automatic_markers(known({{30, 4}, {36, 0}}), known({{30, 5}, {45, 0}}), {});
      },
      ThrowsMessage<MismatchError>(HasSubstr("1 markers, expected at least 4")));
}

TEST(LandmarkNames, SayWhatTheyAre) {
  EXPECT_EQ(landmark_name(0), "jaw (landmark 1)");
  EXPECT_EQ(landmark_name(36), "right eye (landmark 37)");
  EXPECT_EQ(landmark_name(67), "inside of the lips (landmark 68)");
}

}  // namespace
}  // namespace mimetra
