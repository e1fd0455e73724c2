#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/fitting/synthetic_clip.h"
#include "tests/option_ranges.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using Shape = FitOptions::Shape;
using Solver = FitOptions::Solver;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Solver kSolvers[] = {Solver::alternating, Solver::joint};

/// Turns, scales and shifts an image.
Eigen::Matrix<double, 2, 3> similarity(double scale, double angle, double x, double y) {
  Eigen::Matrix<double, 2, 3> S;
  S << scale * std::cos(angle), -scale * std::sin(angle), x,  //
      scale * std::sin(angle), scale * std::cos(angle), y;
  return S;
}

TEST(LandmarkFitter, FindsTheSameFaceInATurnedScaledAndShiftedImage) {
  const auto expect_same = [](const FitOptions& options, unsigned seed, double sigma_error) {
    test::SyntheticClip clip = test::synthetic_clip(seed, {.frames = 2});
    const auto before = test::fit(clip, options);
    for (const auto& S : {similarity(1, 1.1, 0, 0), similarity(7, 0, 0, 0),
                          similarity(1, 0, 3000, -200), similarity(0.01, -2, 5, 90)}) {
      test::SyntheticClip other = clip;
      for (Eigen::Index f = 0; f < 2; ++f) {
        for (Eigen::Index i = 0; i < clip.points.cols(); i += 2) {
          other.points.row(f).segment<2>(i) =
              S * clip.points.row(f).segment<2>(i).transpose().homogeneous();
        }
      }
      const auto after = test::fit(other, options);
      for (std::size_t f = 0; f < 2; ++f) {
        EXPECT_LT((after[f].alpha - before[f].alpha).norm(), 1e-6);
        EXPECT_LT((after[f].beta - before[f].beta).norm(), 1e-6);
        AffineCamera camera = S.leftCols<2>() * before[f].camera;
        camera.col(3) += S.col(2);
        EXPECT_LT((after[f].camera - camera).norm(), 1e-6 * camera.norm());
        const double scale = S.col(0).norm();
        EXPECT_NEAR(after[f].rms, scale * before[f].rms, 1e-6 * scale);
        EXPECT_NEAR(after[f].sigma, scale * before[f].sigma, sigma_error * scale);
      }
    }
  };
  for (unsigned seed = 0; seed < 3; ++seed) {
    expect_same({.solver = Solver::alternating, .iterations = 20}, seed, 1e-9);
    expect_same({.iterations = 20, .repeated = 0, .camera = FitOptions::Camera::affine}, seed,
                1e-9);
    // An estimated noise comes from the fit, and is as exact as that.
    expect_same({.iterations = 20}, seed, 1e-6);
  }
}

TEST(LandmarkFitter, RecoversExpressionsOfTheMeanExactly) {
  for (const Solver solver : kSolvers) {
    const test::SyntheticClip clip =
        test::synthetic_clip(4, {.frames = 4, .identity_size = 0, .noise = 0});
    const auto fits = test::fit(clip, {.solver = solver,
                                       .iterations = 2000,
                                       .tolerance = 0,
                                       .repeated = 0,
                                       .camera = FitOptions::Camera::affine});
    for (std::size_t f = 0; f < 4; ++f) {
      // The energy is 0 there, and sqrt(rounding of the squared coordinates) from it elsewhere.
      EXPECT_LT(fits[f].rms, 1e-6);
      EXPECT_LT(fits[f].alpha.norm(), 1e-6);
      EXPECT_LT((fits[f].beta.transpose() - clip.beta.row(static_cast<Eigen::Index>(f))).norm(),
                1e-6);
      EXPECT_LT((fits[f].camera - clip.cameras[f]).norm(), 1e-4);
    }
  }
}

TEST(LandmarkFitter, RecoversIdentityAndExpressionsWhereNoiseIsTakenForSmall) {
  const test::SyntheticClip clip = test::synthetic_clip(6, {.landmarks = 30, .noise = 0});
  const FrameFit fit =
      test::fit(clip, {.solver = Solver::joint, .iterations = 100, .tolerance = 0, .sigma = 1e-4})
          .front();
  // The prior pulls by sigma^2 over the squared motion of the landmarks in pixels: 1e-8 / 100.
  EXPECT_LT((fit.alpha - clip.alpha).norm(), 1e-6);
  EXPECT_LT((fit.beta.transpose() - clip.beta.row(0)).norm(), 1e-6);
}

TEST(LandmarkFitter, KeepsExpressionsWithinTheirBounds) {
  for (const Solver solver : kSolvers) {
    const test::SyntheticClip clip = test::synthetic_clip(8, {.frames = 20, .noise = 8});
    double least = 1, most = 0, unbounded = 0;
    for (const FrameFit& fit : test::fit(clip, {.solver = solver})) {
      least = std::min(least, fit.beta.minCoeff());
      most = std::max(most, fit.beta.maxCoeff());
    }
    EXPECT_EQ(least, 0);
    EXPECT_EQ(most, 1);
    for (const FrameFit& fit :
         test::fit(clip, {.solver = solver, .max_expression = std::nullopt})) {
      unbounded = std::max(unbounded, fit.beta.maxCoeff());
      EXPECT_GE(fit.beta.minCoeff(), 0);
    }
    EXPECT_GT(unbounded, 1);
  }
}

TEST(LandmarkFitter, TakesTheNoiseFromTheSizeOfTheFace) {
  const test::SyntheticClip clip = test::synthetic_clip(9);
  const ImagePoints image = clip.points.row(0).reshaped<Eigen::RowMajor>(clip.points.cols() / 2, 2);
  const double radius =
      std::sqrt((image.rowwise() - image.colwise().mean()).squaredNorm() / double(image.rows()));
  EXPECT_DOUBLE_EQ(test::fit(clip, {}).front().sigma, 0.017485 * radius);
  EXPECT_EQ(test::fit(clip, {.sigma = 2.5}).front().sigma, 2.5);
}

TEST(LandmarkFitter, ShrinksManyExpressionsByDefault) {
  const test::SyntheticClip few = test::synthetic_clip(10, {.landmarks = 40, .expressions = 10});
  EXPECT_EQ(test::fit(few, {}).front().beta, test::fit(few, {.ridge = 0}).front().beta);
  const test::SyntheticClip many = test::synthetic_clip(10, {.landmarks = 40, .expressions = 12});
  EXPECT_EQ(test::fit(many, {}).front().beta, test::fit(many, {.ridge = 0.25}).front().beta);
  EXPECT_LT(test::fit(many, {.ridge = 100}).front().beta.norm(),
            test::fit(many, {}).front().beta.norm());
}

TEST(LandmarkFitter, FitsWhatIsSeenOfAFrame) {
  const test::SyntheticClip clip = test::synthetic_clip(11, {.landmarks = 20});
  test::SyntheticClip part = clip;
  std::vector<int> vertices;
  Frames points(1, 24);
  for (int i = 0, at = 0; i < 20; ++i) {
    if (i % 5 < 2) {
      part.points(0, 2 * i) = kNan;
    } else {
      vertices.push_back(clip.vertices[i]);
      points.row(0).segment<2>(2 * at++) = clip.points.row(0).segment<2>(2 * i);
    }
  }
  const FrameFit expected = LandmarkFitter(clip.model, vertices).fit(points).front();
  const FrameFit fit = test::fit(part, {}).front();
  EXPECT_EQ(fit.landmarks, 12);
  EXPECT_EQ(fit.alpha, expected.alpha);
  EXPECT_EQ(fit.beta, expected.beta);
  EXPECT_EQ(fit.camera, expected.camera);
}

TEST(LandmarkFitter, TakesTheWayBetweenNeighboursWhereNothingIsSeen) {
  for (const Shape shape : {Shape::clip, Shape::frame}) {
    test::SyntheticClip clip = test::synthetic_clip(12, {.frames = 5});
    for (const int unseen : {0, 2, 4}) clip.points.row(unseen).setConstant(kNan);
    clip.times[2] = clip.times[1] + 0.25 * (clip.times[3] - clip.times[1]);
    const auto fits = test::fit(clip, {.shape = shape});
    EXPECT_EQ(fits[0].beta, fits[1].beta);
    EXPECT_EQ(fits[4].beta, fits[3].beta);
    EXPECT_LT((fits[2].beta - 0.75 * fits[1].beta - 0.25 * fits[3].beta).norm(), 1e-12);
    EXPECT_LT((fits[2].alpha - 0.75 * fits[1].alpha - 0.25 * fits[3].alpha).norm(), 1e-12);
    EXPECT_LT((fits[2].camera - 0.75 * fits[1].camera - 0.25 * fits[3].camera).norm(), 1e-9);
    if (shape == Shape::clip) {
      EXPECT_EQ(fits[2].alpha, fits[1].alpha);
    }
    EXPECT_EQ(fits[2].landmarks, 0);
    EXPECT_TRUE(std::isnan(fits[2].rms));
    EXPECT_EQ(fits[3].landmarks, 20);
  }
}

TEST(LandmarkFitter, SmoothsAcrossAGapAsLongAsItIs) {
  // Still, then a second of nothing, then another face: no reason to bend on either side.
  constexpr int kBefore = 20, kAfter = 20;
  test::SyntheticClip clip = test::synthetic_clip(14, {.frames = kBefore + kAfter});
  for (int f = 0; f < clip.beta.rows(); ++f) clip.beta.row(f).setConstant(f < kBefore ? 0.2 : 0.8);
  std::mt19937 random(1);
  test::see(clip, 0.1, random);
  clip.times.tail(kAfter).array() += 1;
  const auto smooth = test::fit(clip, {.smoothness = 0.1});
  for (int f = 0; f < clip.beta.rows(); ++f) {
    EXPECT_LT((smooth[static_cast<std::size_t>(f)].beta - clip.beta.row(f).transpose())
                  .cwiseAbs()
                  .maxCoeff(),
              0.1)
        << f;
  }
}

TEST(LandmarkFitter, CanBeCancelled) {
  const test::SyntheticClip clip = test::synthetic_clip(15, {.frames = 3});
  const LandmarkFitter fitter(clip.model, clip.vertices);
  for (const Shape shape : {Shape::clip, Shape::frame}) {
    EXPECT_THROW(fitter.fit(clip.points, {.shape = shape, .tolerance = 0}, clip.times, {},
                            Context().with_progress([](double) { return false; })),
                 Cancelled);
  }
}

TEST(LandmarkFitter, FitsModelsOfOneBasis) {
  for (const Solver solver : kSolvers) {
    const test::SyntheticClip plain = test::synthetic_clip(13, {.identities = 0});
    EXPECT_EQ(test::fit(plain, {.solver = solver}).front().alpha.size(), 0);
    EXPECT_LT(test::fit(plain, {.solver = solver}).front().rms, 3);
    const test::SyntheticClip still = test::synthetic_clip(13, {.expressions = 0});
    EXPECT_EQ(test::fit(still, {.solver = solver}).front().beta.size(), 0);
    EXPECT_LT(test::fit(still, {.solver = solver}).front().rms, 3);
  }
}

TEST(LandmarkFitter, NamesTheFrameThatHasNoCamera) {
  const test::SyntheticClip clip = test::synthetic_clip(14, {.frames = 3});
  const auto refusal = [&](const MorphableModel& model, const Frames& points) {
    return test::message_of<MismatchError>(
        [&] { LandmarkFitter(model, clip.vertices).fit(points, {}, clip.times); });
  };
  Frames few = clip.points;
  few.row(2).tail(2 * 17).setConstant(kNan);
  EXPECT_THAT(refusal(clip.model, few),
              HasSubstr("frame 2: 3 landmarks, an affine camera needs at least 4"));
  Positions flat = clip.model.mean();
  flat.col(1).setZero();
  EXPECT_THAT(refusal({clip.model.shared_connectivity(), flat, {}, {}}, clip.points),
              HasSubstr("frame 0: the 20 landmarks are coplanar"));
  EXPECT_THAT(refusal(clip.model, Frames::Constant(3, 40, 5)),
              HasSubstr("frame 0: all landmarks are at one place"));
  EXPECT_THAT(refusal(clip.model, Frames::Constant(3, 40, kNan)),
              HasSubstr("no frame has landmarks"));
}

TEST(LandmarkFitter, RefusesAVertexThatTheModelLacksAndAnotherNumberOfLandmarks) {
  test::SyntheticClip clip = test::synthetic_clip(15);
  EXPECT_THAT(test::message_of<MismatchError>([&] {
                LandmarkFitter(clip.model, {0, 23});
              }),
              HasSubstr("a landmark is at vertex 23, but the model has vertices 0 to 22"));
  clip.vertices.pop_back();
  EXPECT_THAT(test::message_of<std::invalid_argument>([&] { test::fit(clip, {}); }),
              HasSubstr("40 columns, expected x and y of 19 landmarks"));
}

TEST(LandmarkFitter, ChecksTheRangesOfItsOptions) {
  test::expect_ranges<FitOptions>();
}

TEST(LandmarkFitter, RefusesOptionsOutOfRangeOrWithoutWhatTheyNeed) {
  const test::SyntheticClip clip = test::synthetic_clip(16);
  const auto message = [&](const FitOptions& options) {
    return test::message_of<std::invalid_argument>([&] { test::fit(clip, options); });
  };
  EXPECT_THAT(message({.iterations = 0}), HasSubstr("iterations is 0; it must be from 1"));
  EXPECT_THAT(message({.max_expression = 0}),
              HasSubstr("max_expression is 0; it must be at least"));
  EXPECT_THAT(message({.max_expression = 2, .smoothness = 1}),
              HasSubstr("smoothness needs expressions of at most 1"));
  EXPECT_THAT(message({.camera = FitOptions::Camera::perspective}), HasSubstr("focal length"));
  EXPECT_THAT(message({.focal_length = 1000}), HasSubstr("focal length"));
  const LandmarkFitter fitter(clip.model, clip.vertices);
  EXPECT_THAT(
      test::message_of<std::invalid_argument>([&] { fitter.fit(clip.points, {.smoothness = 1}); }),
      HasSubstr("0 times for 1 frames"));
}

TEST(LandmarkFitter, RefusesWhatTheAlternationHasNot) {
  const test::SyntheticClip clip = test::synthetic_clip(16);
  const auto message = [&](FitOptions options) {
    options.solver = Solver::alternating;
    return test::message_of<std::invalid_argument>([&] { test::fit(clip, options); });
  };
  EXPECT_THAT(message({.camera = FitOptions::Camera::orthographic}),
              HasSubstr("affine cameras only"));
  EXPECT_THAT(message({.outliers = FitOptions::Outliers::resist}),
              HasSubstr("trusts all landmarks"));
  EXPECT_THAT(message({.repeated = 0.5}), HasSubstr("frames for independent"));
}

}  // namespace
}  // namespace mimetra
