#pragma once

#include <optional>

#include "toolkit/mesh/progress.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// How the start decides between a component and its negative.
enum class SignRule {
  amplitude,  ///< by the norms of the projections as they are; equal norms by time (well-posed)
  literal     ///< by the norms of the projections, each divided by its maximum (reference, 2013)
};

struct DecompositionOptions {
  /// K, 1 .. 3N.
  int count = 50;
  /// Support map: 0 up to d_min, 1 from d_max. Lengths; by default 0.1 and 0.7 of the rest pose's
  /// longest side.
  std::optional<double> d_min = {};
  std::optional<double> d_max = {};
  /// Weight lambda >= 0 of the sparsity term, for X scaled to standard deviation 1.
  double sparsity = 2;
  /// Penalty rho > 0 of ADMM.
  double rho = 10;
  /// Outer iterations at most, >= 1, and ADMM steps in each, >= 1.
  int iterations = 10;
  int admm_iterations = 10;
  /// Stop when the energy changes by less than this share of itself; 0 runs all iterations.
  double tolerance = 1e-4;
  /// Keep weights >= 0; otherwise they are signed, with max |w| = 1.
  bool nonnegative = true;
  SignRule sign_rule = SignRule::amplitude;
  /// Iterate on the motion's coordinates in as few poses over time as keep its Frobenius norm up to
  /// this share, at least 1e-6; 0 iterates on all frames. The start always does.
  double basis_tolerance = 0;
  /// Iterate in single precision. The start is in double precision in any case.
  bool single_precision = false;
  /// Distances along the rest pose; by default SurfaceDistances of its exactly welded vertices.
  DistanceFunction distances = {};
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Progress progress = {};
};

}  // namespace mimetra
