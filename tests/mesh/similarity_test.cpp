#include "toolkit/mesh/similarity.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/shapes.h"

namespace mimetra {
namespace {

Positions random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Positions::NullaryExpr(count, 3, [&] { return normal(random); });
}

Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

Positions moved(const Positions& points, double scale, const Eigen::Matrix3d& rotation,
                const Eigen::RowVector3d& by) {
  return (scale * points * rotation.transpose()).rowwise() + by;
}

TEST(Similarity, IsFoundWhateverItIs) {
  const Positions from = random_points(30, 1);
  const Eigen::RowVector3d by(300, -20, 7);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const Positions to = moved(from, scale, some_rotation(), by);
    const Similarity found = similarity_fit(from, to);
    // So far away, the small ones have lost five digits.
    EXPECT_NEAR(found.scale, scale, 1e-9 * scale);
    EXPECT_TRUE(found.rotation.isApprox(some_rotation(), 1e-9));
    EXPECT_FALSE(found.mirrors());
    EXPECT_NEAR(found.angle(), 2.1 * 180 / EIGEN_PI, 1e-7);
    EXPECT_LT((found.apply(from) - to).cwiseAbs().maxCoeff(), 1e-12 * (scale + by.norm()));
  }
}

TEST(Similarity, KeepsVerticesAtOnePlaceTogether) {
  // Of different parity and far apart, so that nothing depends on how rows are grouped.
  Positions points = random_points(37, 8);
  for (const int row : {5, 18, 36}) points.row(row) = points.row(2);
  const Similarity there = similarity_fit(points, moved(points, 0.01, some_rotation(), {7, 8, 9}));
  const Positions carried = there.apply(points);
  for (const int row : {5, 18, 36}) EXPECT_TRUE(carried.row(row) == carried.row(2)) << row;
}

TEST(Similarity, IsBitByBitTheIdentityForEqualPoints) {
  const Positions points = random_points(10, 2);
  const Similarity found = similarity_fit(points, points);
  EXPECT_TRUE(found.is_identity());
  EXPECT_TRUE(found.apply(points) == points);
  EXPECT_EQ(found.angle(), 0);
}

TEST(Similarity, MirrorsOnlyWhereThatIsMuchBetter) {
  const Positions from = random_points(30, 3);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  const Similarity found =
      similarity_fit(from, moved(from, 2, some_rotation() * mirror, {1, 2, 3}));
  EXPECT_TRUE(found.mirrors());
  EXPECT_TRUE(found.rotation.isApprox(some_rotation() * mirror, 1e-12));
  // Nearly flat points and their mirror image differ by their noise only.
  Positions flat = from;
  flat.col(2) *= 1e-3;
  EXPECT_FALSE(similarity_fit(flat, flat + 1e-2 * random_points(30, 4)).mirrors());
}

TEST(Similarity, OfFlatPointsTurnsThemProperly) {
  const Positions from = test::grid(4, 3).positions;
  const Positions to = moved(from, 1, some_rotation(), {0, 0, 0});
  const Similarity found = similarity_fit(from, to);
  EXPECT_FALSE(found.mirrors());
  EXPECT_TRUE(found.rotation.isApprox(some_rotation(), 1e-12));
}

TEST(Similarity, OfPointsOnALineIsRefused) {
  Positions line = Positions::Zero(5, 3);
  line.col(0).setLinSpaced(0, 1);
  EXPECT_THROW(similarity_fit(line, moved(line, 2, some_rotation(), {1, 1, 1})), MismatchError);
  EXPECT_THROW(similarity_fit(Positions::Zero(4, 3), random_points(4, 5)), MismatchError);
  EXPECT_THROW(similarity_fit(random_points(4, 5), random_points(5, 5)), std::invalid_argument);
}

TEST(Similarity, CarriesAMotionToTheOtherSide) {
  const Positions points = random_points(12, 6);
  const RigidTransform motion{some_rotation(), {3, 4, 5}};
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()).toRotationMatrix() *
        Eigen::Vector3d(1, sign, 1).asDiagonal();
    const Similarity there = similarity_fit(points, moved(points, 0.01, turn, {-7, 1, 2}));
    const RigidTransform carried = there.carry(motion);
    EXPECT_NEAR(carried.rotation.determinant(), 1, 1e-12);
    // First moved and then carried is first carried and then moved.
    EXPECT_TRUE(
        carried.apply(there.apply(points)).isApprox(there.apply(motion.apply(points)), 1e-12));
  }
}

TEST(Similarity, ScalingKeepsTheAxes) {
  const Positions from = random_points(30, 7);
  const Positions to = moved(from, 1000, some_rotation(), {5, 6, 7});
  const Similarity found = scaling_fit(from, to);
  EXPECT_NEAR(found.scale, 1000, 1e-9);
  EXPECT_TRUE(found.rotation == Eigen::Matrix3d::Identity());
  EXPECT_THROW(scaling_fit(Positions::Zero(4, 3), random_points(4, 5)), MismatchError);
}

}  // namespace
}  // namespace mimetra
