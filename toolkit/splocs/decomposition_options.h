#pragma once

#include <optional>

#include "toolkit/mesh/option.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// Choice of the start between a component and its negative.
enum class SignRule {
  amplitude,  ///< by the norms of the projections; equal norms by time (well-posed)
  literal     ///< by the norms of the projections, each divided by its maximum (reference, 2013)
};

/// The iterate that a decomposition returns. The energy can rise between iterates, because support
/// maps follow their components.
enum class ReturnedIterate {
  best,  ///< iterate of least energy, the first of equals; costs a copy of C, W and the maps
  last   ///< last iterate, whatever its energy (reference, 2013)
};

/// Precision of the numbers in the iterations.
enum class IterationPrecision { double_precision, single_precision };

constexpr std::string_view choice_name(IterationPrecision value) {
  switch (value) {
    case IterationPrecision::double_precision:
      return "double";
    case IterationPrecision::single_precision:
      return "single";
  }
  return {};
}

/// Divisor of X.
enum class MotionScale {
  root_mean_square,   ///< RMS of the displacements' coordinates; rotating the mesh does not change
                      ///< it
  standard_deviation  ///< deviation of the same coordinates (reference, 2013)
};

/// Displacements up to this share of the rest pose's diameter count as no motion. It covers the
/// rounding of float32 files (6e-8 of their coordinates) and of rigid alignment.
constexpr double kLeastMotion = 1e-6;

/// Weights of the connected parts of a surface, from 0 to 1. A component's centre is the vertex
/// with the largest product of weight and squared motion.
///
/// The start also lets each component move parts that are not connected to its centre, by 1 -
/// weight of the motion explained there. In the paper it moves nothing there. So a tooth moves with
/// the components of the jaw and needs none of its own.
struct PartWeights {
  std::vector<int> of_vertex = {};   ///< part of each vertex (N); empty for a single part
  std::vector<double> weights = {};  ///< weight of each part, 1 for the largest

  bool empty() const { return of_vertex.empty(); }
  /// Weight of each vertex (N), or empty.
  Eigen::VectorXd of_vertices() const;
};

struct DecompositionOptions {
  /// Number of components K, at most 3N.
  int count = 50;
  /// The support map is 0 up to d_min and 1 from d_max, both lengths. By default they are these
  /// shares of the rest pose's diameter().
  static constexpr double kMinimumShare = 0.1, kMaximumShare = 0.7;
  std::optional<double> d_min = {};
  std::optional<double> d_max = {};
  MotionScale scale = MotionScale::root_mean_square;
  /// Weight lambda of the sparsity term, for the scaled X.
  double sparsity = 2;
  /// Penalty rho of ADMM.
  double rho = 10;
  /// Maximum number of outer iterations, by default kUsualIterations.
  std::optional<int> iterations = {};
  /// By kUsualIterations the energy's curve has flattened (docs/accuracy.md); the reference runs
  /// kReferenceIterations.
  static constexpr int kUsualIterations = 30, kReferenceIterations = 10;
  /// ADMM steps in each iteration.
  int admm_iterations = 10;
  /// The iterations end when the energy changes by at most this share of itself three times in a
  /// row. If 0, all iterations run, and Components::converged uses kUsualTolerance.
  static constexpr double kUsualTolerance = 1e-4;
  double tolerance = kUsualTolerance;
  /// Keep weights >= 0. Otherwise they are signed, with max |w| = 1.
  bool nonnegative = true;
  SignRule sign_rule = SignRule::amplitude;
  ReturnedIterate returned = ReturnedIterate::best;
  /// Iterate on the motion's coordinates in a basis of as few poses as keep its Frobenius norm up
  /// to this share, at least 1e-6. If 0, iterate on all frames. The start always uses all frames.
  double basis_tolerance = 0;
  /// Precision of the iterations; the start always uses double. Single precision moves components
  /// by about 1e-6 of themselves.
  IterationPrecision precision = IterationPrecision::double_precision;
  /// Connected parts of the surface with their weights; by default all parts are equal, as in the
  /// paper.
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
