#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/surface_distances.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

// Steps of an iteration, in order: weights, support maps, components.

/// Makes `weights` (F) feasible: negative entries become 0 if `nonnegative`, then the largest
/// magnitude becomes 1 (a zero vector stays).
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 3 and 4
Eigen::VectorXd feasible_weights(const Eigen::VectorXd& weights, bool nonnegative);

/// One Gauss-Seidel sweep over the columns of W (F x K) for fixed components C. P = X C^T (F x K)
/// and H = C C^T (K x K) are given. A component without energy gets no weights.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 6
Eigen::MatrixXd updated_weights(Eigen::MatrixXd W, const Eigen::MatrixXd& P,
                                const Eigen::MatrixXd& H, bool nonnegative);

/// Support maps around S vertices of the mesh (N x S), over the whole mesh on each rank.
using SupportFunction = std::function<Eigen::MatrixXd(std::span<const VertexIndex>)>;

/// Support maps from distances between `d_min` and `d_max` (lengths). The function throws
/// std::invalid_argument unless `distances` gives `vertices` rows and one column for each source.
SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max);

/// Support maps of K components, which follow their components' strongest vertices.
class SupportMaps {
 public:
  /// Maps of the n vertices of `part`. `center_weights` as in strongest_vertex(), for all vertices
  /// of the mesh.
  SupportMaps(SupportFunction support, int components, const VertexPart& part,
              Eigen::VectorXd center_weights);

  /// Moves each map to the strongest vertex of its component, row k of `components` (K x 3n). A
  /// component that is zero keeps its map. \pre `reduction` covers the same part
  template <typename Scalar>
  void follow(const VertexBlocks<Scalar>& components, const Reduction& reduction);

  /// K x n; 1 everywhere if a component was always zero.
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

/// Components after an update, with the products that the next weights and the energy need. P, H
/// and the penalty are sums over the mesh, which only the first rank has.
template <typename Scalar>
struct ComponentUpdate {
  VertexBlocks<Scalar> C;  ///< components, K x 3n
  VertexBlocks<Scalar> U;  ///< scaled dual variable of ADMM, K x 3n; kept between updates
  Eigen::MatrixXd P;       ///< X C^T, R x K
  Eigen::MatrixXd H;       ///< C C^T, K x K
  double penalty = 0;      ///< sum_k sum_i Lambda_ki |c_k^(i)|
};

/// Weights of an update, for motion X (R x 3n) in any basis of the rows. Only the first rank needs
/// them.
struct UpdateWeights {
  Eigen::MatrixXd rows;  ///< R x K: W, or Q^T W if X are coordinates in a basis Q
  Eigen::MatrixXd gram;  ///< W^T W, K x K
};

/// Components (K x 3n) and their products before the first ADMM step: U = 0.
template <typename Scalar>
ComponentUpdate<Scalar> initial_components(const BlockSource<Scalar>& X,
                                           VertexBlocks<Scalar> components,
                                           const Reduction& reduction);

/// Runs ADMM steps that minimise
///   ||X - W C||^2 / 2 + sum_k sum_i Lambda_ki |c_k^(i)|
/// from the components and dual variable of `last`. Lambda is sparsity times the `support` maps
/// (K x n). The problem separates into vertices: all steps run on one block of vertices at a time,
/// while it is in cache.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 7 to 9
template <typename Scalar>
ComponentUpdate<Scalar> updated_components(const BlockSource<Scalar>& X, const UpdateWeights& W,
                                           const Frames& support, ComponentUpdate<Scalar> last,
                                           const AdmmOptions& options, const Reduction& reduction);

}  // namespace mimetra
