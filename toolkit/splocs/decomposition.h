#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

struct SequencePart;

/// Sparse localized deformation components: frame f is rest + sum_k W_fk C_k, approximately.
struct Components {
  Positions rest;                    ///< N x 3
  Triangles triangles;               ///< M x 3
  Frames displacements;              ///< C, K x 3N, unit of the mesh
  Eigen::MatrixXd weights;           ///< W, F x K, each column's maximum is 1 (or the column is 0)
  std::vector<VertexIndex> centers;  ///< vertex that component k moves most (K); -1 where it died
  Eigen::MatrixXd support;           ///< support map of component k in that iteration, K x N
  std::vector<double> energies;      ///< after each iteration, for the scaled X
  int iteration = 0;  ///< whose state this is, from 1 to as many as ran; 0 where it is not known
  std::optional<bool> converged = {};  ///< the energy has; none where it is not known
  double scale = 1;                    ///< what X was divided by, in units of the mesh
  double d_min = 0;                    ///< as used, lengths
  double d_max = 0;
  DecompositionOptions options;  ///< as given, but without the caller's functions

  int count() const { return static_cast<int>(displacements.rows()); }
  int vertices() const { return static_cast<int>(rest.rows()); }
};

/// Minimises ||X - W C||_F^2 + sum_k sum_i Lambda_ki |c_k^(i)| subject to W >= 0 and max of each
/// column of W = 1, for X = frames - rest (F x 3N), divided by its
/// root mean square (MotionScale).
///
/// It ends when the energy has converged, at the latest after as many iterations as there may be,
/// and returns the iterate of least energy unless the options want the last.
///
/// Every product with X is with K columns (P = X C^T, W^T X); the residual is never formed. The
/// rest pose is the sequence's.
///
/// Motion that exceeds the memory of the context is kept in a file without a name, or read again
/// for every pass, and fewer threads work at a time. If several ranks share the computation, all
/// read the sequence, but each reads its own vertices only (VertexPart) and computes its share of
/// the distances that the options have; all return the same.
///
/// Throws MismatchError if count > 3N, if there is one frame only, if nothing moves by more than
/// kLeastMotion, or if the memory is too little; std::invalid_argument for options out of range;
/// what reading throws; OutputError if motion cannot be kept in a file; Cancelled.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 1 to 9;
/// Region-based deformation transfer, eq. 6 and 7.
Components decompose(const FrameSource& sequence, const DecompositionOptions& options = {},
                     const Context& = {});

/// The same if each rank has the poses of its own vertices only. The mesh and the options are the
/// whole mesh's and the same on each rank. All ranks return the same, but for displacements
/// (K x 3n) and support (K x n), which are of the rank's n vertices.
///
/// On ranks whose processors are of one kind, the result is the same bits as on one rank. Elsewhere
/// it is that up to rounding: each rank computes the diameter of the mesh, the distances and its
/// own vertices' displacements by itself.
///
/// Throws std::invalid_argument also where a rank has other vertices than its own, or a mesh of
/// another size or other frames than the first rank. What sizes, the rest pose or the motion make
/// it throw, it throws the same on all ranks. Where one rank alone throws anything else (Cancelled
/// from its progress, what its distances throw, std::bad_alloc), the others wait for it: who stops
/// one must stop all.
Components decompose_part(const SequencePart& sequence, const DecompositionOptions& options,
                          const Context& = {});

/// How well components tell the sequence.
struct DecompositionError {
  /// ||X - W C||_F / sqrt(3 N F), unit of the mesh.
  double rms = 0;
  /// rms divided by the diagonal of the rest pose's bounding box.
  double relative_rms = 0;
  /// 100 ||X - W C||_F / ||X - mean over frames||_F, percent; 0 where all frames are the same.
  double kg = 0;
  /// Share of vertex displacements in C that are exactly zero.
  double sparsity = 0;
};

/// Keeps within the memory of the context, as decompose() does. Throws MismatchError if the sizes
/// of sequence and components differ or the memory is too little, and what reading throws.
DecompositionError decomposition_error(const FrameSource& sequence, const Components& components,
                                       const Context& = {});

/// The same for what decompose_part() returned, on all ranks.
DecompositionError decomposition_error(const SequencePart& sequence, const Components& components,
                                       const Context& = {});

/// Distance from each centre that holds `share` of its component's energy (K); 0 where it died.
Eigen::VectorXd energy_radius(const Components& components, const DistanceFunction& distances,
                              double share = 0.95);

}  // namespace mimetra
