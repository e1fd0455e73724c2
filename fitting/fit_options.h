#pragma once

#include <optional>
#include <string_view>

#include "toolkit/mesh/option.h"

namespace mimetra {

/// Standard deviation of landmarks in each direction if it is not estimated, as a share of their
/// RMS distance from their centroid. It is sqrt(3) px for a face of the size it was measured on.
constexpr double kUsualSigma = 0.017485;

struct FitOptions {
  /// `alternating` solves camera, alpha, camera and beta in turn, as in the paper. `joint` takes
  /// Gauss-Newton steps in all of them: two or three steps replace hundreds of alternations.
  enum class Solver { joint, alternating };
  /// `clip` fits one alpha to all frames. `frame` fits an alpha to every frame, which starts from
  /// the previous frame.
  enum class Shape { clip, frame };
  /// `affine`: eight free numbers in each frame, as in the paper. `orthographic`: scaled
  /// orthographic; `stretch` limits how far its rows may differ in length and be askew.
  /// `perspective`: like `orthographic`, but things shrink with distance, by the focal length.
  /// `automatic`: orthographic if the joint solver fits one shape to several frames, else affine.
  enum class Camera { automatic, orthographic, affine, perspective };
  /// `resist` gives little weight to landmarks that are outliers, in units of the clip's noise.
  /// `trust` weights all landmarks alike. `automatic` resists if the noise is estimated.
  enum class Outliers { automatic, resist, trust };

  Solver solver = Solver::joint;
  Shape shape = Shape::clip;
  /// Maximum number of iterations after the noise is estimated, in each frame if shapes differ.
  int iterations = 5;
  /// The solver stops when one iteration lowers the energy by less than this share, in [0, 1].
  double tolerance = 1e-4;
  /// Standard deviation of the landmarks in each direction, in pixels. By default the joint solver
  /// estimates it for one shape in several frames, unless `repeated` is 0. The estimate is a share
  /// of the face's size in each frame. Otherwise it is kUsualSigma x the RMS distance of the used
  /// landmarks from their centroid, in each frame; the scale of the image does not matter.
  std::optional<double> sigma = std::nullopt;
  /// rho in [0, 1], the share of the landmarks' squared error that is the same in every frame. F
  /// frames of one shape count as F / (1 + (F - 1) rho) independent frames: rho is 0 if frames are
  /// independent. It is estimated by default if sigma is, and is 0 otherwise.
  std::optional<double> repeated = std::nullopt;
  Camera camera = Camera::automatic;
  /// Standard deviation of the stretch of a scaled orthographic camera: the difference of its rows'
  /// lengths, and their product, as shares of the length. A face at ten times its depth from the
  /// camera needs 0.1.
  double stretch = 0.1;
  /// Focal length of a perspective camera, in pixels.
  std::optional<double> focal_length = std::nullopt;
  Outliers outliers = Outliers::automatic;
  /// Upper bound of each beta, > 0. Without it, beta is only bounded by 0 from below.
  std::optional<double> max_expression = 1;
  /// Weight of |beta|^2 relative to |alpha|^2. The default of 0.125 for each expression beyond ten
  /// makes fifty expressions as strong as in real performances.
  std::optional<double> ridge = std::nullopt;
  /// Time constant of smooth expressions, in seconds; see smoothness_penalty(). Smoothing starts
  /// from the solver's result without it. Needs max_expression = 1.
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

/// Name of the choice on the command line.
constexpr std::string_view choice_name(FitOptions::Solver value) {
  switch (value) {
    case FitOptions::Solver::joint:
      return "joint";
    case FitOptions::Solver::alternating:
      return "alternating";
  }
  return {};
}

/// Name of the choice on the command line.
constexpr std::string_view choice_name(FitOptions::Shape value) {
  switch (value) {
    case FitOptions::Shape::clip:
      return "clip";
    case FitOptions::Shape::frame:
      return "frame";
  }
  return {};
}

/// Name of the choice on the command line.
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

/// Name of the choice on the command line.
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
