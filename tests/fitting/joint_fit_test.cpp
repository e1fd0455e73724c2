#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fitting/synthetic_clip.h"

namespace mimetra {
namespace {

using Camera = FitOptions::Camera;
using Shape = FitOptions::Shape;
using Solver = FitOptions::Solver;

/// The joint solver with what the paper's minimises.
FitOptions of_the_paper(Shape shape, int iterations) {
  return {.shape = shape,
          .iterations = iterations,
          .tolerance = 0,
          .repeated = 0,
          .camera = Camera::affine};
}

TEST(JointFit, ReachesNoMoreThanTheEnergyOfTheAlternation) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const test::SyntheticClip clip = test::synthetic_clip(seed, {.frames = 1 + int(seed % 4)});
    for (const Shape shape : {Shape::clip, Shape::frame}) {
      const auto last = [&](Solver solver) {
        FitOptions options = of_the_paper(shape, 5);
        options.solver = solver;
        double sum = 0;
        for (const FrameFit& fit : test::fit(clip, options)) sum += fit.energies.back();
        return sum;
      };
      EXPECT_LE(last(Solver::joint), last(Solver::alternating) * (1 + 1e-9)) << seed;
    }
  }
}

TEST(JointFit, NeverRaisesTheEnergy) {
  for (unsigned seed = 0; seed < 45; ++seed) {
    const test::SyntheticClip clip =
        test::synthetic_clip(seed, {.frames = 1 + int(seed % 3), .noise = 10});
    for (const FitOptions& options :
         {of_the_paper(Shape::clip, 8), FitOptions{.iterations = 8, .tolerance = 0}}) {
      const auto fits = test::fit(clip, options);
      const auto& energies = fits.front().energies;
      EXPECT_TRUE(std::is_sorted(energies.rbegin(), energies.rend())) << seed;
    }
  }
}

TEST(JointFit, EndsWhereTheAlternationHasNothingToGain) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const test::SyntheticClip clip = test::synthetic_clip(seed, {.frames = 3});
    const auto joint = test::fit(clip, of_the_paper(Shape::clip, 60));
    const auto slow =
        test::fit(clip, {.solver = Solver::alternating, .iterations = 3000, .tolerance = 0});
    // Both end at the same minimum. The energy is flat there: its error is the square of theirs.
    EXPECT_NEAR(joint.front().energies.back(), slow.front().energies.back(),
                1e-9 * slow.front().energies.back());
    EXPECT_LT((joint.front().alpha - slow.front().alpha).norm(), 1e-4);
    for (std::size_t f = 0; f < joint.size(); ++f) {
      EXPECT_LT((joint[f].beta - slow[f].beta).norm(), 1e-4);
    }
  }
}

TEST(JointFit, IsWithinAPercentOfTheMinimumAfterThreeSteps) {
  const test::SyntheticClip clip = test::synthetic_clip(3, {.landmarks = 50, .identities = 40});
  const auto energy = [&](int iterations) {
    return test::fit(clip, of_the_paper(Shape::clip, iterations)).front().energies.back();
  };
  EXPECT_LT(energy(3), 1.01 * energy(50));
}

}  // namespace
}  // namespace mimetra
