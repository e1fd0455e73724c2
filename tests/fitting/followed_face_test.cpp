#include "fitting/followed_face.h"

#include <gmock/gmock.h>

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A square face by the place of its middle.
FaceBox at(double x, double size = 100) {
  return {{x, 300}, {size, size}};
}

TEST(FollowedFace, IsTheLargestOfTheFirstFrameWithAny) {
  EXPECT_THAT(followed_face({{}, {at(100), at(500, 120), at(900, 120)}, {at(900), at(500)}}).chosen,
              ElementsAre(-1, 1, 1));
}

TEST(FollowedFace, IsFollowedWhereTheOrderOfFacesChanges) {
  EXPECT_THAT(
      followed_face({{at(100, 110), at(500)}, {at(510), at(120)}, {at(140), at(520)}}).chosen,
      ElementsAre(0, 1, 0));
}

/// The detector misses it, and has only somebody else.
TEST(FollowedFace, IsNotSomebodyElseWhereItIsMissed) {
  const FollowedFace face = followed_face({{at(100, 110), at(500)}, {at(501)}, {at(105), at(502)}});
  EXPECT_THAT(face.chosen, ElementsAre(0, -1, 0));
  EXPECT_THAT(face.jumps, IsEmpty());
  // Whichever of them comes first.
  EXPECT_THAT(followed_face({{at(100), at(500, 110)}, {at(101)}, {at(102), at(505)}}).chosen,
              ElementsAre(1, -1, 1));
}

/// Also where that one is there for the first time, which only later frames tell.
TEST(FollowedFace, IsNotSomebodyElseWhoComesWhileItIsMissed) {
  EXPECT_THAT(followed_face({{at(100)}, {at(500)}, {at(500), at(105)}, {at(110)}}).chosen,
              ElementsAre(0, -1, 1, 0));
}

/// Detectors find one face twice.
TEST(FollowedFace, IsOneWhereItsBoxesLieOnEachOther) {
  const FollowedFace face =
      followed_face({{at(100)}, {at(100), at(103)}, {at(104)}, {at(107), at(102)}, {at(105)}});
  EXPECT_THAT(face.chosen, ElementsAre(0, 0, 0, 1, 0));
  EXPECT_THAT(face.jumps, IsEmpty());
}

TEST(FollowedFace, MayCrossWhereSomebodyElseWas) {
  std::vector<std::vector<FaceBox>> frames = {{at(0, 110), at(400)}};
  for (int f = 1; f < 60; ++f) frames.push_back({at(10 * f)});
  const FollowedFace face = followed_face(frames);
  EXPECT_THAT(face.chosen, testing::Each(0));
  EXPECT_THAT(face.jumps, IsEmpty());
}

TEST(FollowedFace, IsTakenUpAfterALongAbsence) {
  std::vector<std::vector<FaceBox>> frames = {{at(100, 110), at(500)}};
  for (int f = 0; f < 200; ++f) frames.push_back({at(500)});
  frames.push_back({at(500), at(160)});
  // Farther from where it was, but never seen beside itself.
  for (int f = 0; f < 200; ++f) frames.push_back({at(500)});
  frames.push_back({at(500), at(300)});
  const FollowedFace face = followed_face(frames);
  EXPECT_EQ(face.chosen[200], -1);
  EXPECT_EQ(face.chosen[201], 1);
  EXPECT_EQ(face.chosen[401], -1);
  EXPECT_EQ(face.chosen[402], 1);
  EXPECT_THAT(face.jumps, ElementsAre(402));
}

TEST(FollowedFace, IsNobodyWhereItNeverComesBack) {
  EXPECT_THAT(followed_face({{at(100, 110), at(500)}, {at(500)}, {at(520)}}).chosen,
              ElementsAre(0, -1, -1));
}

TEST(FollowedFace, MayJumpWhereItIsAlone) {
  const FollowedFace face = followed_face({{at(100)}, {at(900)}, {}, {at(100)}, {at(400)}});
  EXPECT_THAT(face.chosen, ElementsAre(0, 0, -1, 0, 0));
  EXPECT_THAT(face.jumps, IsEmpty());
}

/// What a detector takes for a face in one frame makes nobody of those that were not beside it.
TEST(FollowedFace, MayJumpWithACutInAClipOfSeveral) {
  const FollowedFace face =
      followed_face({{at(100)}, {at(100), at(700, 50)}, {at(400)}, {at(410)}, {at(100)}});
  EXPECT_THAT(face.chosen, ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(face.jumps, ElementsAre(2));
}

/// Two people, each alone and then both.
TEST(FollowedFace, IsOneOfThoseThatAreSeenTogetherLater) {
  EXPECT_THAT(followed_face({{at(100)}, {at(600)}, {at(100)}, {at(100), at(600)}}).chosen,
              ElementsAre(0, -1, 0, 0));
}

/// Shares of an image that is twice as wide as high.
TEST(FollowedFace, IsMeasuredByItsOwnWidthAndHeight) {
  const auto share = [](double x, double y) { return FaceBox{{x, y}, {0.1, 0.2}}; };
  EXPECT_THAT(followed_face({{share(0.3, 0.5), share(0.8, 0.5)}, {share(0.3, 0.65)}}).jumps,
              IsEmpty());
  EXPECT_THAT(followed_face({{share(0.3, 0.5), share(0.8, 0.5)}, {share(0.45, 0.5)}}).jumps,
              ElementsAre(1));
}

}  // namespace
}  // namespace mimetra
