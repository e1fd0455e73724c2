#include <algorithm>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "tests/fitting/literal_fit.h"
#include "tests/fitting/synthetic_clip.h"

namespace mimetra {
namespace {

using Shape = FitOptions::Shape;
constexpr auto kAlternating = FitOptions::Solver::alternating;

// Normal equations against QR: condition numbers of some hundreds, squared, times rounding.
constexpr double kLiteralRounding = 1e-9;

TEST(Alternation, IsThePapers) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const std::optional<double> upper : {std::optional(1.0), std::optional<double>()}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      const test::SyntheticClip clip = test::synthetic_clip(seed);
      test::LiteralFit literal(clip.model, clip.vertices, clip.points.row(0), 2,
                               upper.value_or(kInfinity), 0.3);
      for (int iteration = 1; iteration <= 4; ++iteration) {
        literal.iterate();
        const FrameFit fit = test::fit(clip, {.solver = kAlternating,
                                              .iterations = iteration,
                                              .tolerance = 0,
                                              .sigma = 2,
                                              .max_expression = upper,
                                              .ridge = 0.3})
                                 .front();
        EXPECT_LT((fit.camera - literal.camera).norm(), kLiteralRounding * literal.camera.norm());
        EXPECT_LT((fit.alpha - literal.alpha).norm(), kLiteralRounding);
        EXPECT_LT((fit.beta - literal.beta).norm(), kLiteralRounding);
        EXPECT_NEAR(fit.rms, literal.rms(), kLiteralRounding);
        ASSERT_EQ(fit.energies.size(), static_cast<std::size_t>(iteration));
        EXPECT_NEAR(fit.energies.back(), literal.energy(), kLiteralRounding * literal.energy());
      }
    }
  }
}

TEST(Alternation, StartsAFrameFromTheOneBefore) {
  const test::SyntheticClip clip = test::synthetic_clip(5, {.frames = 3});
  test::LiteralFit literal(clip.model, clip.vertices, clip.points.row(0), 2, 1, 0);
  literal.iterate();
  for (int f = 1; f < 3; ++f) {
    test::LiteralFit next(clip.model, clip.vertices, clip.points.row(f), 2, 1, 0);
    next.alpha = literal.alpha;
    next.beta = literal.beta;
    literal = next;
    literal.iterate();
  }
  const auto fits =
      test::fit(clip, {.solver = kAlternating, .shape = Shape::frame, .iterations = 1, .sigma = 2});
  EXPECT_LT((fits[2].alpha - literal.alpha).norm(), kLiteralRounding);
  EXPECT_LT((fits[2].beta - literal.beta).norm(), kLiteralRounding);
}

TEST(Alternation, SolvesForOneIdentityOfTheClip) {
  const test::SyntheticClip clip = test::synthetic_clip(7, {.frames = 6});
  const auto fits =
      test::fit(clip, {.solver = kAlternating, .iterations = 2000, .tolerance = 0, .sigma = 2});
  for (const FrameFit& fit : fits) EXPECT_EQ(fit.alpha, fits.front().alpha);

  // The gradient of eq. 4, summed over frames, vanishes at alpha: 2 alpha = -sum A^T r / sigma^2.
  // It ends where the energy, some hundreds, falls by no more than its rounding, 1e-13. The
  // gradient is the square root of that times the curvature, some hundreds as well: below 1e-5.
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(clip.alpha.size());
  for (std::size_t f = 0; f < fits.size(); ++f) {
    const Positions pose = clip.model.person(fits[f].alpha).pose(fits[f].beta);
    const ImagePoints residual =
        clip.points.row(static_cast<Eigen::Index>(f))
            .reshaped<Eigen::RowMajor>(static_cast<Eigen::Index>(clip.vertices.size()), 2) -
        project(fits[f].camera, pose(clip.vertices, Eigen::all));
    for (Eigen::Index j = 0; j < pull.size(); ++j) {
      const Positions field =
          clip.model.identities().displacements.col(j).reshaped<Eigen::RowMajor>(
              clip.model.vertices(), 3);
      const ModelPoints moved = field(clip.vertices, Eigen::all);
      pull[j] += (moved * fits[f].camera.leftCols<3>().transpose()).cwiseProduct(residual).sum();
    }
  }
  EXPECT_LT((2 * fits.front().alpha - pull / 4).norm(), 1e-5);
}

/// Largest rise of the energy relative to it. Up to rounding, each step minimises it.
double largest_rise(const std::vector<double>& energies) {
  double rise = 0;
  for (std::size_t i = 1; i < energies.size(); ++i) {
    rise = std::max(rise, energies[i] / energies[i - 1] - 1);
  }
  return rise;
}

TEST(Alternation, NeverRaisesTheEnergy) {
  for (unsigned seed = 0; seed < 42; ++seed) {  // each size with each number of frames, twice
    const int size = static_cast<int>(seed % 7);
    const test::SyntheticClip clip = test::synthetic_clip(seed, {.landmarks = 10 + 3 * size,
                                                                 .identities = 1 + 2 * size,
                                                                 .expressions = 7 - size,
                                                                 .frames = 1 + int(seed % 3),
                                                                 .noise = 0.5 * size});
    for (const Shape shape : {Shape::clip, Shape::frame}) {
      for (const double smoothness : {0.0, 0.05}) {
        for (const FrameFit& fit : test::fit(clip, {.solver = kAlternating,
                                                   .shape = shape,
                                                   .iterations = 10,
                                                   .tolerance = 0,
                                                   .smoothness = smoothness})) {
          EXPECT_LE(largest_rise(fit.energies), 1e-10) << seed;
        }
      }
    }
  }
}

TEST(Alternation, EndsWhereTheEnergyHardlyFalls) {
  const test::SyntheticClip clip = test::synthetic_clip(1);
  const FrameFit fit =
      test::fit(clip, {.solver = kAlternating, .iterations = 1000, .tolerance = 1e-3}).front();
  const auto& energies = fit.energies;
  ASSERT_EQ(energies.size(), static_cast<std::size_t>(fit.iterations));
  ASSERT_GE(fit.iterations, 2);
  ASSERT_LT(fit.iterations, 1000);
  const auto fall = [&](std::size_t i) { return 1 - energies[i] / energies[i - 1]; };
  EXPECT_LT(fall(energies.size() - 1), 1e-3);
  for (std::size_t i = 1; i + 1 < energies.size(); ++i) EXPECT_GE(fall(i), 1e-3);
}

TEST(Alternation, BendsLessWithSmoothness) {
  const test::SyntheticClip clip = test::synthetic_clip(2, {.frames = 30});
  const auto bend = [&](double smoothness) {
    const auto fits = test::fit(clip, {.shape = Shape::frame, .smoothness = smoothness});
    double sum = 0;
    for (std::size_t f = 2; f < fits.size(); ++f) {
      sum += (fits[f].beta - 2 * fits[f - 1].beta + fits[f - 2].beta).squaredNorm();
    }
    return sum;
  };
  // Three frames' time constant weighs second differences 81 times as much as the landmarks.
  EXPECT_LT(bend(3 / 25.0), 0.05 * bend(0));
}

}  // namespace
}  // namespace mimetra
