#pragma once

#include <optional>
#include <string_view>

#include "toolkit/mesh/option.h"

namespace mimetra {

/// Standard deviation of landmarks in each direction where it is not estimated, as a share of their
/// RMS distance from their centroid: sqrt(3) px for the face of the size it was found on.
constexpr double kUsualSigma = 0.017485;

struct FitOptions {
  /// `alternating`: camera, alpha, camera, beta, in turn, as in the paper. `joint`: Gauss-Newton
  /// steps of all of them together, two or three of which reach what hundreds of iterations do.
  enum class Solver { joint, alternating };
  /// `clip`: one alpha for all frames; `frame`: an alpha in every frame, which starts from the
  /// frame before.
  enum class Shape { clip, frame };
  /// `affine`: eight free numbers in each frame, as in the paper. `orthographic`: scaled
  /// orthographic, an affine camera whose rows may differ in length and be askew by `stretch`.
  /// `perspective`: the same, and what is farther away is smaller by the focal length.
  /// `automatic`: orthographic where the joint solver fits one shape to several frames, else
  /// affine.
  enum class Camera { automatic, orthographic, affine, perspective };
  /// `resist`: landmarks that are not like the others, in units of the clip's own noise, count
  /// little; `trust`: all count alike. `automatic`: resist where the noise is estimated.
  enum class Outliers { automatic, resist, trust };

  Solver solver = Solver::joint;
  Shape shape = Shape::clip;
  /// Iterations at most; in every frame where each has its shape.
  int iterations = 5;
  /// It ends where the energy falls by less than this share of it in one iteration.
  double tolerance = 1e-4;
  /// Noise of the landmarks, a standard deviation in each direction. By default the joint solver
  /// estimates it where it fits one shape to several frames, as a share of the face's size in each;
  /// elsewhere it is kUsualSigma x the RMS distance of the used landmarks from their centroid, in
  /// each frame, so that the image's scale changes nothing.
  std::optional<double> sigma = std::nullopt;
  /// rho, the share of the landmarks' squared error that is the same in every frame: F frames of
  /// one shape say as much of it as F / (1 + (F - 1) rho). 0 where frames are independent;
  /// estimated by default where sigma is, else 0.
  std::optional<double> repeated = std::nullopt;
  Camera camera = Camera::automatic;
  /// Standard deviation of a scaled orthographic camera's stretch: the difference of its rows'
  /// lengths, and their product, as shares of the length. A face at ten times its depth from the
  /// camera needs 0.1.
  double stretch = 0.1;
  /// Of a perspective camera.
  std::optional<double> focal_length = std::nullopt;
  Outliers outliers = Outliers::automatic;
  /// Upper bound of each beta, > 0. Without a bound, beta is only at least 0.
  std::optional<double> max_expression = 1;
  /// Weight of |beta|^2 beside |alpha|^2. By default 0.125 for each expression beyond ten, so that
  /// fifty are as strong as in real performances.
  std::optional<double> ridge = std::nullopt;
  /// Time constant that is the weight of squared second differences of beta over time. The
  /// alternation finds it, from where the solver ends without it. Needs max_expression = 1.
  double smoothness = 0;

  static constexpr Option kSolver{"solver", &FitOptions::solver};
  static constexpr Option kShape{"shape", &FitOptions::shape};
  static constexpr Option kIterations{
      "iterations", &FitOptions::iterations, {.minimum = 1, .maximum = 1e6}};
  static constexpr Option kTolerance{
      "tolerance", &FitOptions::tolerance, {.minimum = 0, .maximum = 1}};
  static constexpr Option kSigma{
      "sigma", &FitOptions::sigma, {.minimum = 1e-9, .maximum = 1e9}, "pixels"};
  static constexpr Option kRepeated{
      "repeated", &FitOptions::repeated, {.minimum = 0, .maximum = 1}};
  static constexpr Option kCamera{"camera", &FitOptions::camera};
  static constexpr Option kStretch{
      "stretch", &FitOptions::stretch, {.minimum = 1e-3, .maximum = 1e3}};
  static constexpr Option kFocalLength{
      "focal-length", &FitOptions::focal_length, {.minimum = 1, .maximum = 1e9}, "pixels"};
  static constexpr Option kOutliers{"outliers", &FitOptions::outliers};
  static constexpr Option kMaxExpression{
      "max_expression", &FitOptions::max_expression, {.minimum = 1e-300}};
  static constexpr Option kRidge{"ridge", &FitOptions::ridge, {.minimum = 0, .maximum = 1e9}};
  static constexpr Option kSmoothness{
      "smoothness", &FitOptions::smoothness, {.minimum = 0, .maximum = 1e6}, "seconds"};
  static constexpr auto declared() {
    return std::tuple(kSolver, kShape, kIterations, kTolerance, kSigma, kRepeated, kCamera,
                      kStretch, kFocalLength, kOutliers, kMaxExpression, kRidge, kSmoothness);
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

/// As people choose it.
constexpr std::string_view choice_name(FitOptions::Camera value) {
  switch (value) {
    case FitOptions::Camera::automatic:
      return "auto";
    case FitOptions::Camera::orthographic:
      return "orthographic";
    case FitOptions::Camera::affine:
      return "affine";
    case FitOptions::Camera::perspective:
      return "perspective";
  }
  return {};
}

/// As people choose it.
constexpr std::string_view choice_name(FitOptions::Outliers value) {
  switch (value) {
    case FitOptions::Outliers::automatic:
      return "auto";
    case FitOptions::Outliers::resist:
      return "resist";
    case FitOptions::Outliers::trust:
      return "trust";
  }
  return {};
}

}  // namespace mimetra
