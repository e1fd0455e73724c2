#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/fitting/two_videos.h"

/// The cameras of the joint solver against its energy, written as it is defined.
namespace mimetra {
namespace {

using Camera = FitOptions::Camera;

/// What the joint solver minimises where the noise is known.
struct LiteralEnergy {
  const test::SyntheticClip& clip;
  double sigma, repeated, stretch, focal_length;

  /// |y - projection|^2 / (2 sigma^2) of all landmarks, the cameras' stretch, and the prior for as
  /// many independent frames as these are.
  double operator()(const std::vector<AffineCamera>& cameras, const Eigen::VectorXd& alpha,
                    const Eigen::MatrixXd& beta) const {
    const BlendshapeModel person = clip.model.person(alpha);
    const double frames = double(cameras.size());
    double sum = (1 + (frames - 1) * repeated) * alpha.squaredNorm();
    for (std::size_t f = 0; f < cameras.size(); ++f) {
      const auto row = static_cast<Eigen::Index>(f);
      const Positions pose = person.pose(beta.row(row));
      const Eigen::RowVector3d a = cameras[f].row(0).head<3>(), b = cameras[f].row(1).head<3>();
      const double scale = std::sqrt((a.squaredNorm() + b.squaredNorm()) / 2);
      for (std::size_t i = 0; i < clip.vertices.size(); ++i) {
        const Eigen::RowVector3d x = pose.row(clip.vertices[i]);
        const double depth = 1 + a.cross(b).dot(x) / scale / focal_length;
        const Eigen::RowVector2d seen(a.dot(x) / depth + cameras[f](0, 3),
                                      b.dot(x) / depth + cameras[f](1, 3));
        const Eigen::RowVector2d found = clip.points.row(row).segment<2>(2 * Eigen::Index(i));
        sum += (found - seen).squaredNorm() / (2 * sigma * sigma);
      }
      const double lengths = (a.squaredNorm() - b.squaredNorm()) / (2 * scale * scale);
      const double angle = a.dot(b) / (scale * scale);
      sum += (lengths * lengths + angle * angle) / (2 * stretch * stretch);
    }
    return sum;
  }
};

TEST(CameraModel, OfTheJointSolverEndsAtAMinimumOfItsEnergy) {
  for (const double focal_length : {std::numeric_limits<double>::infinity(), 1500.0}) {
    const test::SyntheticClip clip =
        test::synthetic_clip(3, {.landmarks = 25, .frames = 3, .noise = 1});
    FitOptions options{.iterations = 200,
                       .tolerance = 0,
                       .sigma = 1.5,
                       .repeated = 0.3,
                       .camera = Camera::orthographic,
                       .stretch = 0.02};
    if (std::isfinite(focal_length)) {
      options.camera = Camera::perspective;
      options.focal_length = focal_length;
    }
    const auto fits = test::fit(clip, options);
    Eigen::MatrixXd beta(3, clip.model.expressions().size());
    std::vector<AffineCamera> cameras;
    for (std::size_t f = 0; f < 3; ++f) {
      beta.row(static_cast<Eigen::Index>(f)) = fits[f].beta;
      cameras.push_back(fits[f].camera);
      cameras.back().leftCols<3>() -= fits[f].camera.col(3) * fits[f].depth.head<3>();
    }
    EXPECT_EQ(fits.front().sigma, 1.5);
    EXPECT_EQ(fits.front().repeated, 0.3);
    const LiteralEnergy energy{clip, 1.5, 0.3, 0.02, focal_length};
    const Eigen::VectorXd& alpha = fits.front().alpha;
    const double least = energy(cameras, alpha, beta);
    EXPECT_NEAR(fits.front().energies.back(), least, 1e-9 * least);
    if (std::isfinite(focal_length)) continue;  // there a step takes each landmark's depth as it is
    // A step away along any unknown costs its square; what a slope would gain is 1e4 times that.
    constexpr double kStep = 1e-4, kOfRounding = 1e-9;
    for (const double step : {-kStep, kStep}) {
      for (Eigen::Index j = 0; j < alpha.size(); ++j) {
        Eigen::VectorXd other = alpha;
        other[j] += step;
        EXPECT_GT(energy(cameras, other, beta), least - kOfRounding * least);
      }
      for (std::size_t f = 0; f < 3; ++f) {
        for (Eigen::Index j = 0; j < beta.cols(); ++j) {
          Eigen::MatrixXd other = beta;
          double& value = other(static_cast<Eigen::Index>(f), j);
          value = std::clamp(value + step, 0.0, 1.0);
          EXPECT_GT(energy(cameras, alpha, other), least - kOfRounding * least);
        }
        for (Eigen::Index j = 0; j < 8; ++j) {
          std::vector<AffineCamera> other = cameras;
          other[f].reshaped()[j] += step * (j < 6 ? 1e-2 : 1);
          EXPECT_GT(energy(other, alpha, beta), least - kOfRounding * least);
        }
      }
    }
  }
}

TEST(CameraModel, OfAPerspectiveCameraFindsTheFaceThatAnOrthographicOneBends) {
  const MorphableModel& head = test::built_in_head();
  std::mt19937 random(1);
  test::SyntheticClip clip{head, test::vertices_of_landmarks(), {}, {}, {}, {}, {}};
  constexpr int kFrames = 40;
  constexpr double kFocalLength = 1500;  // 3.3 times the face's 450 px
  clip.alpha = test::normal_matrix(head.identities().size(), 1, random);
  clip.beta = test::random_weights(kFrames, head.expressions().size(), random);
  clip.times = Eigen::VectorXd::LinSpaced(kFrames, 0, 4);
  const double scale = test::kFacePixels / extent(head.mean());
  const BlendshapeModel person = head.person(clip.alpha);
  clip.points.resize(kFrames, 2 * static_cast<Eigen::Index>(clip.vertices.size()));
  for (Eigen::Index f = 0; f < kFrames; ++f) {
    AffineCamera camera = test::turning_camera(clip.times[f], 0, scale);
    const Eigen::RowVector3d a = camera.row(0).head<3>(), b = camera.row(1).head<3>();
    Eigen::RowVector4d depth(0, 0, 0, 1);
    depth.head<3>() = a.cross(b) / scale / kFocalLength;
    camera.leftCols<3>() += camera.col(3) * depth.head<3>();
    const ModelPoints points = person.pose(clip.beta.row(f))(clip.vertices, Eigen::all);
    const auto n = static_cast<Eigen::Index>(clip.vertices.size());
    clip.points.row(f) =
        test::as_row(project(camera, points, depth) + test::normal_matrix(n, 2, random));
  }
  const auto error = [&](const FitOptions& options) {
    return (test::fit(clip, options).front().alpha - clip.alpha).norm();
  };
  const double near = error({.camera = Camera::perspective, .focal_length = kFocalLength});
  EXPECT_LT(near, 0.5 * error({.camera = Camera::orthographic}));
  EXPECT_LT(near, 0.5 * error({.camera = Camera::affine}));
}

}  // namespace
}  // namespace mimetra
