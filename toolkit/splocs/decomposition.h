#pragma once

#include <optional>
#include <vector>

#include <mimetra/mesh/errors.h>
#include <mimetra/mesh/mesh_sequence.h>
#include <mimetra/splocs/surface_distances.h>

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
  /// this share, at least kLeastCompression; 0 iterates on all frames. The start always does.
  double compression = 0;
  /// Iterate in single precision. The start is in double precision in any case.
  bool single_precision = false;
  /// Distances along the rest pose; by default SurfaceDistances of its exactly welded vertices.
  DistanceFunction distances = {};
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Progress progress = {};
};

/// Sparse localized deformation components: frame f is rest + sum_k W_fk C_k, approximately.
struct Components {
  Positions rest;                    ///< N x 3
  Triangles triangles;               ///< M x 3
  Frames displacements;              ///< C, K x 3N, unit of the mesh
  Eigen::MatrixXd weights;           ///< W, F x K, each column's maximum is 1 (or the column is 0)
  std::vector<VertexIndex> centers;  ///< vertex that component k moves most (K); -1 where it died
  Eigen::MatrixXd support;           ///< support map of component k in the last iteration, K x N
  std::vector<double> energies;      ///< after each iteration, for X scaled to standard deviation 1
  double scale = 1;                  ///< standard deviation of X, in units of the mesh
  double d_min = 0;                  ///< as used, lengths
  double d_max = 0;
  DecompositionOptions options;  ///< as given, but without the caller's functions

  int count() const { return static_cast<int>(displacements.rows()); }
  int vertices() const { return static_cast<int>(rest.rows()); }
};

/// Minimises ||X - W C||_F^2 + sum_k sum_i Lambda_ki |c_k^(i)| subject to W >= 0 and max of each
/// column of W = 1, for X = frames - rest (F x 3N), divided by its standard deviation.
///
/// Every product with X is with K columns (P = X C^T, W^T X); the residual is never formed. The
/// result is the same for every number of threads. The rest pose is the sequence's.
///
/// Throws MismatchError where count > 3N, where there is one frame only, or nothing moves;
/// std::invalid_argument for options out of range; Cancelled.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 1 to 9;
/// Region-based deformation transfer, eq. 6 and 7.
Components decompose(const MeshSequence& sequence, const DecompositionOptions& options = {});

/// How well components tell the sequence.
struct DecompositionError {
  /// ||X - W C||_F / sqrt(3 N F), unit of the mesh.
  double rms = 0;
  /// rms divided by the diagonal of the rest pose's bounding box.
  double relative_rms = 0;
  /// 100 ||X - W C||_F / ||X - mean over frames||_F, percent.
  double kg = 0;
  /// Share of vertex displacements in C that are exactly zero.
  double sparsity = 0;
};

/// Throws MismatchError where the sizes of sequence and components differ.
DecompositionError decomposition_error(const MeshSequence& sequence, const Components& components);

/// Distance from each centre that holds `share` of its component's energy (K); 0 where it died.
Eigen::VectorXd energy_radius(const Components& components, const DistanceFunction& distances,
                              double share = 0.95);

}  // namespace mimetra
