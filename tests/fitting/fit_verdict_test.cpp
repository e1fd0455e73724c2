#include "fitting/fit_verdict.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/fitting/two_videos.h"

namespace mimetra {
namespace {

/// A square of two triangles whose one identity moves a corner across the other diagonal.
MorphableModel square() {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  Positions mean(4, 3);
  mean << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(12, 1);
  displacement(3) = -1;
  displacement(4) = 1;
  return {std::make_shared<Connectivity>(Connectivity::from_triangles(4, triangles)),
          mean,
          ShapeBasis{{"fold"}, displacement},
          {}};
}

Eigen::VectorXd coefficients(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

TEST(FitVerdict, CountsTrianglesThatTheIdentityTurnsOver) {
  EXPECT_EQ(verdict_of(square(), coefficients(0.4)).flipped, 0);
  EXPECT_EQ(verdict_of(square(), coefficients(0.6)).flipped, 1);
}

TEST(FitVerdict, DoubtsFoldsAndLargeCoefficients) {
  EXPECT_FALSE(verdict_of(square(), coefficients(0.4)).is_doubtful());
  EXPECT_TRUE(verdict_of(square(), coefficients(0.6)).is_doubtful());
  EXPECT_TRUE(verdict_of(square(), coefficients(-3.6)).is_doubtful());
  EXPECT_EQ(verdict_of(square(), coefficients(-3.6)).alpha_max, 3.6);
}

TEST(FitVerdict, MeasuresNeutralsInShareOfTheFace) {
  const NeutralDistance distance = neutral_distance(square(), coefficients(0), coefficients(0.5));
  EXPECT_NEAR(distance.largest, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distance.mean, std::sqrt(0.5) / 4, 1e-12);
}

TEST(FitVerdict, TellsExpressionsThatAreAlwaysThere) {
  Eigen::MatrixXd beta(4, 3);
  beta << 0, 0.8, 1, 1, 0.9, 1, 0, 0.7, 1, 0, 0.8, 0;
  const auto uses = expression_use(beta);
  EXPECT_EQ(uses[0].at_zero, 0.75);
  EXPECT_EQ(uses[0].at_one, 0.25);
  EXPECT_FALSE(uses[0].is_constant());
  EXPECT_TRUE(uses[1].is_constant());
  EXPECT_TRUE(uses[2].is_constant());
}

TEST(FitVerdict, SeesWhichLandmarksAreBehindTheFace) {
  const MorphableModel head = samples::parametric_head();
  const std::vector<int> vertices = test::vertices_of_landmarks();
  const auto averted = [&](double angle) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    AffineCamera camera = AffineCamera::Zero();
    camera.leftCols<3>() = Eigen::Vector2d(1, -1).asDiagonal() * turn.topRows<2>();
    return averted_landmarks(head.mean(), head.connectivity().triangles, vertices, camera);
  };
  const int all = static_cast<int>(vertices.size());
  EXPECT_LT(averted(0), all / 4);
  EXPECT_GE(averted(1.4), all / 4);
  EXPECT_GT(averted(3.14), 3 * all / 4);
}

}  // namespace
}  // namespace mimetra
