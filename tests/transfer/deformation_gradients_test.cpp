#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {
namespace {

using test::patch;
using test::Shape;

Eigen::Matrix3d rotation() {
  return Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
}

TEST(DeformationGradients, AreALinearMapWhereTheMapIsASimilarity) {
  const Shape shape = patch();
  const Eigen::Matrix3d map = 2.5 * rotation();
  const Positions moved =
      (shape.positions * map.transpose()).rowwise() + Eigen::RowVector3d(4, 5, 6);
  const DeformationGradients gradients(shape.positions, shape.triangles,
                                       all_triangles(shape.triangles));
  const auto q = gradients(moved);
  for (int t = 0; t < shape.triangles.rows(); ++t) {
    // Rounding of products of numbers near 10.
    EXPECT_LT((q.middleRows<3>(3 * t) - map).cwiseAbs().maxCoeff(), 1e-12) << t;
  }
}

TEST(DeformationGradients, OfDegenerateTrianglesAreTheMeanOfTheirNeighbours) {
  Shape shape = patch();
  const int needle = 40;
  const auto corners = shape.triangles.row(needle);
  // The third corner falls on the edge of the first two.
  shape.positions.row(corners[2]) =
      (shape.positions.row(corners[0]) + shape.positions.row(corners[1])) / 2;
  const Eigen::Matrix3d map = rotation();
  const DeformationGradients gradients(shape.positions, shape.triangles, {needle});
  EXPECT_EQ(gradients.replaced(), 1);
  const Eigen::Matrix3d q = gradients(shape.positions * map.transpose());
  EXPECT_LT((q - map).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(DeformationGradients, OfALoneDegenerateTriangleAreTheIdentity) {
  Positions line(3, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  const Eigen::Matrix3d q = DeformationGradients(line, triangles, {0})(5 * line);
  EXPECT_EQ(q, Eigen::Matrix3d::Identity());
}

TEST(DeformationGradients, RefuseATriangleOutOfRange) {
  const Shape shape = patch();
  EXPECT_THROW(DeformationGradients(shape.positions, shape.triangles, {128}),
               std::invalid_argument);
  EXPECT_THROW(DeformationGradients(shape.positions, shape.triangles, {-1}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
