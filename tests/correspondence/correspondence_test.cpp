#include "toolkit/correspondence/correspondence.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// On a target of any size up to 10000 vertices, all of which markers reach.
SurfaceFit lying_at(const Positions& positions) {
  return {positions, std::vector<bool>(positions.rows(), true), std::vector<bool>(10000, true),
          SubjectBox{.diagonal = box_diagonal(positions)}};
}

std::vector<int> partners_of(const Correspondence& pairs, int target_triangle) {
  std::vector<int> partners;
  for (int p = pairs.offsets[target_triangle]; p < pairs.offsets[target_triangle + 1]; ++p) {
    partners.push_back(pairs.parts[p].triangle);
  }
  return partners;
}

TEST(Correspondence, OfAMeshWithItselfIsTheIdentity) {
  const TriMesh sphere = test::mesh_of(test::sphere(2));
  const Correspondence pairs =
      pair_triangles(lying_at(sphere.positions), sphere.connectivity.triangles, sphere);
  const Correspondence identity = Correspondence::identity(128);
  EXPECT_EQ(pairs.parts, identity.parts);
  EXPECT_EQ(pairs.offsets, identity.offsets);
  EXPECT_LT(pairs.residuals.maxCoeff(), 1e-15);
}

TEST(Correspondence, GivesEachPartOfASplitTriangleTheWhole) {
  const test::Shape coarse = test::octahedron(), fine = test::subdivided(coarse);
  const Correspondence pairs =
      pair_triangles(lying_at(coarse.positions), coarse.triangles, test::mesh_of(fine));
  for (int t = 0; t < 32; ++t) EXPECT_THAT(partners_of(pairs, t), ElementsAre(t / 4));
}

TEST(Correspondence, GivesAJoinedTriangleItsPartsByArea) {
  const test::Shape coarse = test::octahedron(), fine = test::subdivided(coarse);
  const Correspondence pairs =
      pair_triangles(lying_at(fine.positions), fine.triangles, test::mesh_of(coarse));
  for (int t = 0; t < 8; ++t) {
    EXPECT_THAT(partners_of(pairs, t), ElementsAre(4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3));
    for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
      EXPECT_NEAR(pairs.parts[p].weight, 0.25, 1e-15);
    }
  }
}

TEST(Correspondence, LeavesWhatIsNotThereWithoutPartner) {
  test::Shape eye = test::sphere(1);
  eye.positions = (0.2 * eye.positions).rowwise() + Eigen::RowVector3d(4, 0, 0);
  const test::Shape head = test::sphere(2);
  const Correspondence pairs = pair_triangles(lying_at(head.positions), head.triangles,
                                              test::mesh_of(test::both(head, eye)));
  for (int t = 0; t < 128; ++t) EXPECT_TRUE(pairs.has_partner(t));
  for (int t = 128; t < 160; ++t) EXPECT_FALSE(pairs.has_partner(t));
}

TEST(Correspondence, EndsAtTheSourcesBorder) {
  const test::Shape narrow = test::grid(4, 4), wide = test::grid(8, 4);
  const Correspondence pairs =
      pair_triangles(lying_at(narrow.positions), narrow.triangles, test::mesh_of(wide));
  for (int t = 0; t < wide.triangles.rows(); ++t) {
    const double x =
        (wide.positions(wide.triangles(t, 0), 0) + wide.positions(wide.triangles(t, 1), 0) +
         wide.positions(wide.triangles(t, 2), 0)) /
        3;
    EXPECT_EQ(pairs.has_partner(t), x < 3) << t;
  }
}

TEST(Correspondence, HasNoPartnersInPartsThatNoMarkerReaches) {
  const test::Shape sphere = test::sphere(1);
  SurfaceFit fit = lying_at(test::both(sphere, sphere).positions);
  std::fill(fit.reached.begin(), fit.reached.begin() + 18, false);
  const Correspondence pairs =
      pair_triangles(fit, test::both(sphere, sphere).triangles, test::mesh_of(sphere));
  for (int t = 0; t < 32; ++t) EXPECT_THAT(partners_of(pairs, t), ElementsAre(32 + t));
}

TEST(Correspondence, GivesNoPartnerToPartsOfTheTargetThatNoMarkerReaches) {
  // Teeth right behind the lips, and facing as they do.
  const test::Shape lips = test::sphere(2);
  test::Shape teeth = lips;
  teeth.positions *= 0.99;
  const TriMesh target = test::mesh_of(test::both(lips, teeth));
  const std::vector<Marker> markers = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};
  const auto found = find_correspondence(test::mesh_of(lips), target, markers);
  for (int t = 0; t < 128; ++t) EXPECT_THAT(partners_of(found.correspondence, t), ElementsAre(t));
  for (int t = 128; t < 256; ++t) EXPECT_FALSE(found.correspondence.has_partner(t));
  EXPECT_EQ(found.quality.without_partner, 0.5);
}

test::Shape ball_at(int level, double x, double y) {
  test::Shape ball = test::sphere(level);
  ball.positions = (0.1 * ball.positions).rowwise() + Eigen::RowVector3d(x, y, 0);
  return ball;
}

TEST(FoundCorrespondence, PairsUnmarkedPartsThatLieOverEachOther) {
  // Teeth within a head; the target is twice as large, finer, has one tooth elsewhere and one more.
  const test::Shape head = test::sphere(2);
  const test::Shape source = test::both(
      head, test::both(ball_at(1, 0.3, 0), test::both(ball_at(1, 0, 0.3), ball_at(1, -0.3, 0))));
  test::Shape target = test::both(
      head, test::both(ball_at(2, 0, 0.3), test::both(ball_at(1, -0.3, 0), ball_at(1, 0.3, -0.4))));
  target.positions *= 2;
  const std::vector<Marker> markers = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};
  const auto found =
      find_correspondence(test::mesh_of(source), test::mesh_of(target), markers).correspondence;
  const auto is_of_ball = [&](int t, int ball) {
    const auto partners = partners_of(found, t);
    return !partners.empty() && std::ranges::all_of(partners, [ball](int partner) {
      return partner >= 128 + 32 * ball && partner < 160 + 32 * ball;
    });
  };
  for (int t = 128; t < 256; ++t) EXPECT_TRUE(is_of_ball(t, 1)) << t;
  for (int t = 256; t < 288; ++t) {
    EXPECT_TRUE(is_of_ball(t, 2)) << t;
    EXPECT_LT(found.residuals[t], 1e-6);
  }
  for (int t = 288; t < 320; ++t) EXPECT_FALSE(found.has_partner(t)) << t;
}

TEST(Correspondence, HasTheSameBytesForEveryNumberOfThreads) {
  const TriMesh source = test::mesh_of(test::sphere(3)), target = test::mesh_of(test::sphere(4));
  const std::vector<Marker> markers = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};
  const auto one = find_correspondence(source, target, markers, {}, Context().with_threads(1));
  const auto three = find_correspondence(source, target, markers, {}, Context().with_threads(3));
  EXPECT_EQ(one.correspondence.parts, three.correspondence.parts);
  EXPECT_EQ(one.correspondence.residuals, three.correspondence.residuals);
  EXPECT_EQ(one.quality.folded, 0);
  EXPECT_EQ(one.quality.without_partner, 0);
  EXPECT_EQ(one.quality.verdict(), "good");
}

TEST(CorrespondenceQuality, NamesWhatIsPoor) {
  CorrespondenceQuality quality;
  quality.partners = 1000;
  quality.mean_residual = 0.01;
  EXPECT_EQ(quality.verdict(), "usable");
  quality.mean_residual = 0.05;
  quality.folded = 20;
  EXPECT_THAT(quality.verdict(), HasSubstr("poor: the deformed source is 5.0 % of its size from"));
  EXPECT_THAT(quality.verdict(), HasSubstr("20 triangles of the deformed source are folded"));
}

}  // namespace
}  // namespace mimetra
