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
  const MorphableModel& head = test::built_in_head();
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

TEST(FitVerdict, TakesAFewSliversOfManyTrianglesForThoseOfTheModel) {
  EXPECT_FALSE((IdentityVerdict{.flipped = 6, .triangles = 13120}.is_doubtful()));
  EXPECT_TRUE((IdentityVerdict{.flipped = 32, .triangles = 6736}.is_doubtful()));
}

/// Two frames of a square, whose corners landmarks are at, seen twice as large.
class FitResidualsTest : public testing::Test {
 protected:
  FitResidualsTest() : sequence_(square().person(coefficients(0)).animate(Eigen::MatrixXd(2, 0))) {
    AffineCamera camera = AffineCamera::Zero();
    camera.leftCols<2>() = 2 * Eigen::Matrix2d::Identity();
    fit_.cameras = {camera, camera};
    fit_.times = Eigen::Vector2d(0, 1);
    fit_.alpha.resize(2, 1);
    fit_.landmarks = Eigen::VectorXi::Constant(2, 4);
    mapped_.names = {"a", "b", "c", "d"};
    mapped_.vertices = {0, 1, 2, 3};
    mapped_.points.resize(2, 8);
    mapped_.points << 0, 0, 2, 0, 2, 2, 0, 2, 0, 0, 2, 0, 2, 2, 0, 2;
  }

  FitResiduals residuals() const { return residuals_of(sequence_, fit_, mapped_); }

  MeshSequence sequence_;
  FittedCoefficients fit_;
  MappedLandmarks mapped_;
};

TEST_F(FitResidualsTest, AreSharesOfTheFacesRadius) {
  EXPECT_EQ(residuals().typical(), 0);
  // One of four corners, which lie sqrt(2) from their middle, is 1 off in both frames.
  mapped_.points(0, 2) = mapped_.points(1, 2) = 3;
  const Eigen::MatrixXd corners = (Eigen::MatrixXd(4, 2) << 0, 0, 3, 0, 2, 2, 0, 2).finished();
  EXPECT_NEAR(residuals().typical(), 0.5 / rms_radius(corners), 1e-12);
  EXPECT_NEAR(residuals().of_landmarks[1], 1, 1e-12);
  EXPECT_EQ(residuals().of_landmarks[0], 0);
}

TEST_F(FitResidualsTest, LeaveOutWhatWasNotSeen) {
  mapped_.points(0, 2) = 3;
  mapped_.points.row(1).setConstant(std::nan(""));
  fit_.landmarks[1] = 0;
  EXPECT_TRUE(std::isnan(residuals().of_frames[1]));
  EXPECT_NEAR(residuals().of_landmarks[1], 1, 1e-12);
  EXPECT_EQ(stretch_of(fit_.cameras, fit_), 1);
}

TEST_F(FitResidualsTest, StretchIsThatOfTheCamerasAxes) {
  for (AffineCamera& camera : fit_.cameras) camera.row(0) *= 3;
  EXPECT_NEAR(stretch_of(fit_.cameras, fit_), 3, 1e-12);
}

}  // namespace
}  // namespace mimetra
