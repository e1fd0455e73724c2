#include <gtest/gtest.h>

#include "tests/fitting/literal_fit.h"
#include "tests/fitting/synthetic_clip.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

struct View {
  AffineCamera camera;
  ModelPoints points;
  ImagePoints image;
};

/// Points of different extent in x, y and z, far from the origin.
View random_view(unsigned seed, int count, double noise) {
  std::mt19937 random(seed);
  View view;
  view.camera = test::random_camera(random);
  view.points = test::normal_matrix(count, 3, random) * Eigen::Vector3d(60, 80, 5).asDiagonal();
  view.points.rowwise() += Eigen::RowVector3d(10, -500, 70);
  view.image = project(view.camera, view.points) + noise * test::normal_matrix(count, 2, random);
  return view;
}

// The closed form squares the condition number, 16 here; entries of the camera are up to 1e3 px.
constexpr double kRounding = 1e-8;

TEST(AffineCamera, IsRecoveredFromFourPointsAndRefusedFromThree) {
  const View view = random_view(1, 4, 0);
  EXPECT_LT((estimate_affine_camera(view.points, view.image) - view.camera).norm(), kRounding);
  EXPECT_THROW(estimate_affine_camera(view.points.topRows(3), view.image.topRows(3)),
               MismatchError);
}

TEST(AffineCamera, IsTheGoldStandardAlgorithms) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const View view = random_view(seed, 30, 2);
    EXPECT_LT((estimate_affine_camera(view.points, view.image) -
               test::literal_camera(view.points, view.image))
                  .norm(),
              kRounding);
  }
}

TEST(AffineCamera, IsFoundDownToAThousandthOfDepth) {
  // Uncorrelated axes, so that the singular values are the extents.
  ModelPoints points(6, 3);
  points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  const ImagePoints image = points.leftCols<2>();
  points.col(2) *= 1.1e-3;
  EXPECT_NO_THROW(estimate_affine_camera(points, image));
  points.col(2) *= 0.9 / 1.1;
  EXPECT_THROW(estimate_affine_camera(points, image), MismatchError);
}

}  // namespace
}  // namespace mimetra
