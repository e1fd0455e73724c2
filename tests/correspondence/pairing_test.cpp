#include "toolkit/correspondence/pairing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// A correspondence of which each target triangle has the partners that are listed, alike.
Correspondence pairs_of(int source_triangles, const std::vector<std::vector<int>>& partners) {
  Correspondence pairs;
  pairs.source_triangles = source_triangles;
  for (const std::vector<int>& of_triangle : partners) {
    for (const int partner : of_triangle) {
      pairs.parts.push_back({partner, 1 / double(of_triangle.size())});
    }
    pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
  }
  pairs.residuals = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(partners.size()));
  return pairs;
}

TEST(Pairing, TakesTargetTrianglesOfWhichHalfIsOverTheSelectedOnes) {
  const Correspondence pairs = pairs_of(4, {{0}, {0, 1}, {1, 2, 3}, {}, {3}});
  EXPECT_THAT(triangles_over(pairs, {0, 1}), ElementsAre(0, 1));
  EXPECT_THAT(triangles_over(pairs, {1}), ElementsAre(1));
  EXPECT_THAT(triangles_over(pairs, {2, 3}), ElementsAre(2, 4));
  EXPECT_THAT(triangles_over(pairs, {}), IsEmpty());
}

TEST(Pairing, OfAMeshWithItselfCarriesEachVertexByItselfAlsoInsideOut) {
  const test::Shape sphere = test::sphere(2);
  test::Shape turned = sphere;
  turned.triangles.col(1).swap(turned.triangles.col(2));
  for (const test::Shape& target : {sphere, turned}) {
    const Pairing pairing(test::mesh_of(sphere), test::mesh_of(target),
                          Correspondence::identity(128));
    EXPECT_TRUE(pairing.is_one_to_one());
    for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
      ASSERT_EQ(pairing.carriers(v).size(), 1u);
      EXPECT_EQ(pairing.carriers(v).front().vertex, v);
      EXPECT_EQ(pairing.carriers(v).front().weight, 1);  // bit by bit
    }
  }
}

TEST(Pairing, FindsTheCornersOfATriangleThatIsWrittenFromAnotherOne) {
  const test::Shape sphere = test::sphere(2);
  test::Shape other = sphere;
  for (int t = 0; t < 128; ++t) {
    for (int c = 0; c < 3; ++c) other.triangles(t, c) = sphere.triangles(t, (c + t) % 3);
  }
  // Another size and place changes nothing.
  other.positions = (3 * other.positions).rowwise() + Eigen::RowVector3d(5, 6, 7);
  const Pairing pairing(test::mesh_of(other), test::mesh_of(sphere), Correspondence::identity(128));
  EXPECT_TRUE(pairing.is_one_to_one());
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    EXPECT_EQ(pairing.carriers(v).front().vertex, v);
  }
}

TEST(Pairing, CarriesNothingWhereNoTriangleHasAPartner) {
  const TriMesh grid = test::mesh_of(test::grid(3, 2));
  const Pairing pairing(grid, grid, pairs_of(4, {{0}, {1}, {}, {}}));
  EXPECT_THAT(with_partners({0, 1, 2, 3}, &pairing), ElementsAre(0, 1));
  EXPECT_THAT(with_partners({2, 3}, nullptr), ElementsAre(2, 3));
  EXPECT_THAT(pairing.carried_vertices(), ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(pairing.over(std::vector<bool>(6, true)),
              ElementsAre(true, true, false, true, true, false));
}

TEST(Pairing, ClosesGapsThatAreMostlyAmongSelectedTriangles) {
  const test::Shape shape = test::grid(5, 2);  // a strip of the triangles 1 0 3 2 5 4 7 6
  const TriMesh grid = test::mesh_of(shape);
  const Pairing pairing(grid, grid, pairs_of(8, {{0}, {1}, {}, {3}, {4}, {}, {}, {7}}));
  EXPECT_THAT(pairing.with_gaps({0, 1, 3, 4}, shape.triangles), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(pairing.with_gaps({7}, shape.triangles), ElementsAre(6, 7));
  EXPECT_THAT(pairing.with_gaps({}, shape.triangles), IsEmpty());
}

TEST(Pairing, RefusesACorrespondenceOfOtherMeshes) {
  const TriMesh sphere = test::mesh_of(test::sphere(2)), grid = test::mesh_of(test::grid(3, 2));
  EXPECT_THAT([&] { Pairing(sphere, grid, Correspondence::identity(128)); },
              ThrowsMessage<MismatchError>("the correspondence is of 128 triangles and 128, the "
                                           "source has 128, the target 4"));
}

}  // namespace
}  // namespace mimetra
