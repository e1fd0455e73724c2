#pragma once

#include <optional>
#include <string_view>

#include "toolkit/mesh/option.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {

struct FitOptions {
  /// `alternating`: camera, alpha, camera, beta, in turn, as in the paper. `joint`: Gauss-Newton
  /// steps of all of them together, two or three of which reach what hundreds of iterations do.
  enum class Solver { joint, alternating };
  /// `clip`: one alpha for all frames; `frame`: an alpha in every frame, which starts from the
  /// frame before.
  enum class Shape { clip, frame };

  Solver solver = Solver::joint;
  Shape shape = Shape::clip;
  /// Iterations at most; in every frame where each has its shape.
  int iterations = 5;
  /// It ends where the energy falls by less than this share of it in one iteration.
  double tolerance = 1e-4;
  /// Noise of the landmarks. By default 0.017485 x the RMS distance of the used landmarks from
  /// their centroid, in each frame, so that the image's scale changes nothing.
  std::optional<double> sigma = std::nullopt;
  /// Upper bound of each beta, > 0; infinity leaves only beta >= 0.
  double max_expression = 1;
  /// Weight of |beta|^2 beside |alpha|^2. By default 0, or 0.1 with more than ten expressions.
  std::optional<double> ridge = std::nullopt;
  /// Time constant that is the weight of squared second differences of beta over time. The
  /// alternation finds it, from where the solver ends without it. Needs max_expression = 1.
  double smoothness = 0;
  Progress progress = {};

  static constexpr Option kSolver{"solver", &FitOptions::solver};
  static constexpr Option kShape{"shape", &FitOptions::shape};
  static constexpr Option kIterations{
      "iterations", &FitOptions::iterations, {.minimum = 1, .maximum = 1e6}};
  static constexpr Option kTolerance{
      "tolerance", &FitOptions::tolerance, {.minimum = 0, .maximum = 1}};
  static constexpr Option kSigma{
      "sigma", &FitOptions::sigma, {.minimum = 1e-9, .maximum = 1e9}, "pixels"};
  static constexpr Option kRidge{"ridge", &FitOptions::ridge, {.minimum = 0, .maximum = 1e9}};
  static constexpr Option kSmoothness{
      "smoothness", &FitOptions::smoothness, {.minimum = 0, .maximum = 1e6}, "seconds"};
  static constexpr auto declared() {
    return std::tuple(kSolver, kShape, kIterations, kTolerance, kSigma, kRidge, kSmoothness);
  }
};

/// As people choose it.
constexpr std::string_view choice_name(FitOptions::Solver value) {
  switch (value) {
    case FitOptions::Solver::joint:
      return "joint";
    case FitOptions::Solver::alternating:
      return "alternating";
  }
  return {};
}

/// As people choose it.
constexpr std::string_view choice_name(FitOptions::Shape value) {
  switch (value) {
    case FitOptions::Shape::clip:
      return "clip";
    case FitOptions::Shape::frame:
      return "frame";
  }
  return {};
}

}  // namespace mimetra
