#include "tests/bench/fitting_bench.h"

#include <string>

#include "tests/fitting/synthetic_clip.h"

namespace mimetra::bench {
namespace {

using Shape = FitOptions::Shape;
using Solver = FitOptions::Solver;

constexpr int kLandmarks = 50, kIdentities = 63, kExpressions = 6, kIterations = 5;

/// The residuals' products with the basis; the Gram matrix of the identities from six folded ones
/// and its factor, in each frame or once for all.
Work work_of(double frames, Shape shape) {
  constexpr double m = kIdentities, n = 2 * kLandmarks, d = kExpressions;
  const double gram = 6 * m * (m + 1), factor = m * m * m / 3;
  const double systems = shape == Shape::frame ? frames : 1;
  return {kIterations * (systems * (gram + factor) + frames * 2 * n * (m + d)), 8 * frames * 2 * n};
}

}  // namespace

std::vector<Row> fitting_rows(const Settings& settings) {
  const int frames = settings.quick ? 20 : 300;
  const test::SyntheticClip clip = test::synthetic_clip(1, {.landmarks = kLandmarks,
                                                            .identities = kIdentities,
                                                            .expressions = kExpressions,
                                                            .frames = frames});
  const LandmarkFitter fitter(clip.model, clip.vertices);
  const Size size{"random model", frames, 0, "landmarks", kLandmarks};
  std::vector<Case> cases;
  for (const auto& [name, solver] :
       {std::pair("alternating", Solver::alternating), std::pair("joint", Solver::joint)}) {
    for (const auto& [what, shape] :
         {std::pair("an identity a frame", Shape::frame), std::pair("one identity", Shape::clip)}) {
      const FitOptions options{
          .solver = solver, .shape = shape, .iterations = kIterations, .tolerance = 0};
      cases.push_back({{"fitting",
                        std::string("fit, ") + name + ", " + what,
                        size,
                        work_of(frames, shape),
                        {"frame", double(frames)}},
                       [&clip, &fitter, options] { fitter.fit(clip.points, options); }});
    }
  }
  return measured(cases, settings.quick);
}

}  // namespace mimetra::bench
