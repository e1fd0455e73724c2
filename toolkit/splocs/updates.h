#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/surface_distances.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

// The steps of an iteration, in their order: weights, support maps, components.

/// `weights` (F) made feasible: negative entries become 0 where `nonnegative`, then the largest
/// magnitude becomes 1 (a zero vector stays).
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 3 and 4
Eigen::VectorXd feasible_weights(const Eigen::VectorXd& weights, bool nonnegative);

/// One Gauss-Seidel sweep over the columns of W (F x K) for fixed components C, from the products
/// P = X C^T (F x K) and H = C C^T (K x K). A component without energy gets no weights.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 6
Eigen::MatrixXd updated_weights(Eigen::MatrixXd W, const Eigen::MatrixXd& P,
                                const Eigen::MatrixXd& H, bool nonnegative);

/// Support maps around some vertices (S) of the mesh, N x S: over the whole mesh on each rank.
using SupportFunction = std::function<Eigen::MatrixXd(std::span<const VertexIndex>)>;

/// Support maps of distances between `d_min` and `d_max` (lengths). The function throws
/// std::invalid_argument where `distances` gives another count than `vertices`.
SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max);

/// The support maps of K components, which follow their components' strongest vertices.
class SupportMaps {
 public:
  /// Those of the n vertices that `part` holds. `center_weights` as of strongest_vertex(), of all
  /// vertices of the mesh.
  SupportMaps(SupportFunction support, int components, const VertexPart& part,
              Eigen::VectorXd center_weights);

  /// Moves each map to the strongest vertex of its component, row k of `components` (K x 3n). A
  /// component that is zero keeps its map. `reduction` over the same part.
  template <typename Scalar>
  void follow(const VertexBlocks<Scalar>& components, const Reduction& reduction);

  /// K x n; 1 everywhere in a map that had no component to follow.
  const Frames& maps() const { return maps_; }

 private:
  SupportFunction support_;
  Eigen::VectorXd center_weights_;
  std::vector<VertexIndex> centers_;
  Frames maps_;
};

struct AdmmOptions {
  double sparsity;  ///< lambda
  double rho;
  int steps;
};

/// Components after an update, with all that the next weights and the energy need of them: P, H and
/// the penalty are sums over the mesh, which the first rank has and no other.
template <typename Scalar>
struct ComponentUpdate {
  VertexBlocks<Scalar> C;  ///< components, K x 3n
  VertexBlocks<Scalar> U;  ///< scaled dual variable of ADMM, K x 3n; it persists over the updates
  Eigen::MatrixXd P;       ///< X C^T, R x K
  Eigen::MatrixXd H;       ///< C C^T, K x K
  double penalty = 0;      ///< sum_k sum_i Lambda_ki |c_k^(i)|
};

/// The weights of an update, for motion X (R x 3n) in any basis of the rows. Only the first rank
/// needs them.
struct UpdateWeights {
  Eigen::MatrixXd rows;  ///< R x K: W, or Q^T W where X are coordinates in a basis Q
  Eigen::MatrixXd gram;  ///< W^T W, K x K
};

/// Products of components (K x 3n) that ADMM has not seen yet: U = 0.
template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const BlockSource<Scalar>& X,
                                           VertexBlocks<Scalar> components,
                                           const Reduction& reduction);

/// ADMM steps for min_C 1/2 ||X - W C||^2 + sum_k sum_i Lambda_ki |c_k^(i)|, Lambda = sparsity
/// times the `support` maps (K x n), from the components and dual variable of `last`. The problem
/// falls apart into vertices: all steps run on one block of them at a time, while it is in cache.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 7 to 9
template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const BlockSource<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options, const Reduction& reduction);

}  // namespace mimetra
