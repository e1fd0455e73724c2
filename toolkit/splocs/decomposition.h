#pragma once

#include <optional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

struct SequencePart;

/// Sparse localized deformation components: frame f is approximately rest + sum_k W_fk C_k.
struct Components {
  Positions rest;                    ///< N x 3
  Triangles triangles;               ///< M x 3
  Frames displacements;              ///< C, K x 3N, unit of the mesh
  Eigen::MatrixXd weights;           ///< W, F x K; each column's maximum is 1 (or the column is 0)
  std::vector<VertexIndex> centers;  ///< vertex that component k moves most (K); -1 if it died
  Eigen::MatrixXd support;           ///< support maps in that iteration, K x N
  std::vector<double> energies;      ///< energy after each iteration, for the scaled X
  int iteration = 0;                 ///< number of the returned iteration, from 1; 0 if unknown
  std::optional<bool> converged = {};  ///< whether the energy converged; none if unknown
  double scale = 1;                    ///< divisor of X, in the unit of the mesh
  double d_min = 0;                    ///< as used, a length
  double d_max = 0;
  DecompositionOptions options;  ///< as given, but without the distance function

  int count() const { return static_cast<int>(displacements.rows()); }
  int vertices() const { return static_cast<int>(rest.rows()); }
};

/// Decomposes a sequence into sparse localized components. X = frames - rest (F x 3N), divided by
/// its scale (MotionScale). It minimises
///   ||X - W C||_F^2 + sum_k sum_i Lambda_ki |c_k^(i)|
/// subject to W >= 0 and max of each column of W = 1.
///
/// It ends when the energy has converged or the allowed iterations are used up. It returns the
/// iterate of least energy unless the options ask for the last.
///
/// Every product with X has K columns (P = X C^T, W^T X); the residual is never formed. The rest
/// pose is the rest pose of the sequence.
///
/// If motion exceeds the memory of the context, it is kept in an unnamed file or read again for
/// every pass, and fewer threads work. If several ranks share the computation, each reads only its
/// own vertices (VertexPart) and computes its share of options.distances. All ranks return the
/// same.
///
/// Throws MismatchError if count > 3N, if there is only one frame, if nothing moves by more than
/// kLeastMotion, or if the memory is too little. Throws std::invalid_argument for options out of
/// range, OutputError if motion cannot be kept in a file, Cancelled, and whatever reading throws.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], eq. 1 to 9;
/// Region-based deformation transfer, eq. 6 and 7.
Components decompose(const FrameSource& sequence, const DecompositionOptions& options = {},
                     const Context& = {});

/// decompose() for ranks that have only the poses of their own vertices. The mesh is the whole
/// mesh; mesh and options are the same on each rank. All ranks return the same, except that
/// displacements (K x 3n) and support (K x n) cover the rank's n vertices.
///
/// On ranks with processors of one kind, the result has the same bits as on one rank. On others it
/// is the same up to rounding, because each rank computes the mesh's diameter, distances and its
/// vertices' displacements by itself.
///
/// Also throws std::invalid_argument if a rank has other vertices than its own, or another mesh
/// size or frame count than the first rank. All ranks throw the same error for wrong sizes, rest
/// pose or motion. If only one rank throws another error (Cancelled, std::bad_alloc, errors of its
/// distances), the others wait for it. A caller that stops one rank must stop all.
Components decompose_part(const SequencePart& sequence, const DecompositionOptions& options,
                          const Context& = {});

/// Accuracy of components against their sequence.
struct DecompositionError {
  /// ||X - W C||_F / sqrt(3 N F), unit of the mesh.
  double rms = 0;
  /// rms divided by the diagonal of the rest pose's bounding box.
  double relative_rms = 0;
  /// 100 ||X - W C||_F / ||X - mean over frames||_F, percent; 0 if all frames are the same.
  double kg = 0;
  /// Share of vertex displacements in C that are exactly zero.
  double sparsity = 0;
};

/// Computes the error within the memory of the context, as decompose() does. Throws MismatchError
/// if the sizes of sequence and components differ or the memory is too little, and whatever reading
/// throws.
DecompositionError decomposition_error(const FrameSource& sequence, const Components& components,
                                       const Context& = {});

/// Computes the error of a result of decompose_part(); all ranks return the same.
DecompositionError decomposition_error(const SequencePart& sequence, const Components& components,
                                       const Context& = {});

/// Distance from each centre (K) that contains `share` of its component's energy. It is 0 if the
/// component died, +infinity if the vertices that can be reached contain less. Throws
/// std::invalid_argument unless 0 < share <= 1.
Eigen::VectorXd energy_radius(const Components& components, const DistanceFunction& distances,
                              double share = 0.95);

}  // namespace mimetra
