#include "fitting/clip_fit.h"

#include <random>

#include <gmock/gmock.h>

#include "samples/head/head.h"
#include "tests/fitting/two_videos.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// People of the built-in head who talk and turn the head, one for each place in the image; the
/// place changes every 40 frames.
struct CutClip {
  static constexpr int kFrames = 160, kRun = 40;
  const MorphableModel& head = test::built_in_head();
  MappedLandmarks mapped;
  Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(kFrames, 0, (kFrames - 1) / 30.0);
  FittedCoefficients fit;

  CutClip(const std::vector<Eigen::VectorXd>& people, const std::vector<double>& places) {
    std::mt19937 random(3);
    for (const auto& [number, vertex] : samples::head_landmarks()) {
      mapped.names.push_back(std::to_string(number));
      mapped.vertices.push_back(vertex);
    }
    mapped.points.resize(kFrames, 2 * Eigen::Index(mapped.vertices.size()));
    const Eigen::MatrixXd beta = test::random_weights(kFrames, head.expressions().size(), random);
    const double scale = 250 / extent(head.mean());
    for (int f = 0; f < kFrames; ++f) {
      const std::size_t shown = std::size_t(f / kRun) % places.size();
      const Positions pose = head.person(people[shown]).pose(beta.row(f));
      AffineCamera camera = test::turning_camera(times[f], 0, scale);
      camera(0, 3) = places[shown];
      const ImagePoints image = project(camera, Positions(pose(mapped.vertices, Eigen::all)));
      mapped.points.row(f) = test::as_row(image + test::normal_matrix(image.rows(), 2, random));
    }
    fit.times = times;
    fit.landmarks = Eigen::VectorXi::Constant(kFrames, int(mapped.vertices.size()));
    fit.alpha.setZero(kFrames, head.identities().size());
  }

  ClipPeople people() const { return people_in(ClipFit(head, mapped, times, {}), fit); }
};

const Eigen::Vector4d kOne(1, -1, 0.5, 1), kOther(-1, 1, -1, -0.5);

/// Each half of the clip shows both, which tells nothing.
TEST(ClipPeople, AreTwoWhereAnotherFaceIsAtEachPlace) {
  const ClipPeople people = CutClip({kOne, kOther}, {300, 900}).people();
  EXPECT_THAT(people.cuts, ElementsAre(40, 80, 120));
  EXPECT_LT(people.halves.value().mean, kTwoPeople);
  EXPECT_GT(people.places.value().mean, kTwoPeople);
}

TEST(ClipPeople, AreOneWhereItsFaceJumps) {
  const ClipPeople people = CutClip({kOne, kOne}, {300, 900}).people();
  EXPECT_THAT(people.cuts, ElementsAre(40, 80, 120));
  EXPECT_LT(people.places.value().mean, kTwoPeople);
}

TEST(ClipPeople, HaveNoPlacesWithoutACutOrWithTooFewFramesAtOne) {
  const ClipPeople still = CutClip({kOne}, {300}).people();
  EXPECT_THAT(still.cuts, IsEmpty());
  EXPECT_FALSE(still.places);
  EXPECT_TRUE(still.halves);
  const ClipPeople four = CutClip({kOne, kOther, kOne, kOther}, {300, 900, 1500, 2100}).people();
  EXPECT_THAT(four.cuts, ElementsAre(40, 80, 120));
  EXPECT_FALSE(four.places);
}

}  // namespace
}  // namespace mimetra
