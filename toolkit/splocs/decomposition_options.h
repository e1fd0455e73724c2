#pragma once

#include <optional>

#include "toolkit/mesh/option.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// How the start decides between a component and its negative.
enum class SignRule {
  amplitude,  ///< by the norms of the projections as they are; equal norms by time (well-posed)
  literal     ///< by the norms of the projections, each divided by its maximum (reference, 2013)
};

/// The iterate that a decomposition returns. Support maps follow their components, so that the
/// energy can rise from one to the next.
enum class ReturnedIterate {
  best,  ///< of least energy, the first of equals: one more copy of C, W and the support maps
  last   ///< whatever its energy (reference, 2013)
};

/// Of the numbers that a decomposition iterates on.
enum class IterationPrecision { double_precision, single_precision };

/// As people choose it.
constexpr std::string_view choice_name(IterationPrecision value) {
  switch (value) {
    case IterationPrecision::double_precision:
      return "double";
    case IterationPrecision::single_precision:
      return "single";
  }
  return {};
}

/// What X is divided by.
enum class MotionScale {
  root_mean_square,   ///< of the displacements' coordinates: turning the mesh does not change it
  standard_deviation  ///< of them (reference, 2013)
};

/// Displacements from the rest pose, as a share of its diameter, up to which nothing moves:
/// what the rounding of float32 files (6e-8 of their coordinates) and of rigid alignment leaves.
constexpr double kLeastMotion = 1e-6;

/// How much each connected part of a surface counts, from 0 to 1: a component's centre is where
/// weight times squared motion is largest, and the start lets each component move the parts that no
/// way leads to by 1 - weight of what its weights explain there, where the paper lets it move
/// nothing. A tooth then goes with the components of the jaw and needs none of its own.
struct PartWeights {
  std::vector<int> of_vertex = {};   ///< part of each vertex (N), or empty: one part
  std::vector<double> weights = {};  ///< of each part, 1 for the largest

  bool empty() const { return of_vertex.empty(); }
  /// Of each vertex (N), or empty.
  Eigen::VectorXd of_vertices() const;
};

struct DecompositionOptions {
  /// K, at most 3N.
  int count = 50;
  /// Support map: 0 up to d_min, 1 from d_max. Lengths; by default these shares of the rest pose's
  /// diameter().
  static constexpr double kMinimumShare = 0.1, kMaximumShare = 0.7;
  std::optional<double> d_min = {};
  std::optional<double> d_max = {};
  MotionScale scale = MotionScale::root_mean_square;
  /// Weight lambda of the sparsity term, for the scaled X.
  double sparsity = 2;
  /// Penalty rho of ADMM.
  double rho = 10;
  /// Outer iterations at most, by default kUsualIterations.
  std::optional<int> iterations = {};
  /// How many that are: where the energy's curve has flattened (docs/accuracy.md), and as many as
  /// the reference runs.
  static constexpr int kUsualIterations = 30, kReferenceIterations = 10;
  /// ADMM steps in each.
  int admm_iterations = 10;
  /// The energy has converged when it changes by at most this share of itself in three iterations
  /// in a row, which ends them; 0 runs all, and says of kUsualTolerance whether it has.
  static constexpr double kUsualTolerance = 1e-4;
  double tolerance = kUsualTolerance;
  /// Keep weights >= 0; otherwise they are signed, with max |w| = 1.
  bool nonnegative = true;
  SignRule sign_rule = SignRule::amplitude;
  ReturnedIterate returned = ReturnedIterate::best;
  /// Iterate on the motion's coordinates in as few poses over time as keep its Frobenius norm up to
  /// this share, at least 1e-6; 0 iterates on all frames. The start always does.
  double basis_tolerance = 0;
  /// The start is in double precision in any case; single moves components by about 1e-6 of
  /// themselves.
  IterationPrecision precision = IterationPrecision::double_precision;
  /// The connected parts of the surface and what they count; by default all alike, as in the paper.
  PartWeights parts = {};
  /// Distances along the rest pose; by default SurfaceDistances of its exactly welded vertices.
  DistanceFunction distances = {};

  static constexpr Option kCount{"count", &DecompositionOptions::count, {.minimum = 1}};
  static constexpr Option kSparsity{"sparsity", &DecompositionOptions::sparsity, {.minimum = 0}};
  static constexpr Option kRho{"rho", &DecompositionOptions::rho, {.minimum = 1e-6}};
  static constexpr Option kIterations{
      "iterations", &DecompositionOptions::iterations, {.minimum = 1}};
  static constexpr Option kAdmmIterations{
      "admm_iterations", &DecompositionOptions::admm_iterations, {.minimum = 1}};
  static constexpr Option kTolerance{
      "tolerance", &DecompositionOptions::tolerance, {.minimum = 0, .maximum = 1}};
  static constexpr Option kNonnegative{"nonnegative", &DecompositionOptions::nonnegative};
  static constexpr Option kPrecision{"precision", &DecompositionOptions::precision};
  static constexpr Option kBasisTolerance{
      "basis_tolerance", &DecompositionOptions::basis_tolerance, {.minimum = 0, .maximum = 0.5}};
  static constexpr auto declared() {
    return std::tuple(kCount, kSparsity, kRho, kIterations, kAdmmIterations, kTolerance,
                      kNonnegative, kPrecision, kBasisTolerance);
  }
};

}  // namespace mimetra
