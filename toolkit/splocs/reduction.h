#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// The vertices of a mesh that belong to one of several ranks.
///
/// Vertices are cut into blocks, and blocks are grouped into runs. Each rank owns consecutive runs.
/// Blocks and runs depend only on the mesh's number of vertices, so results computed run by run are
/// the same for every number of ranks. If there are more ranks than runs, some ranks own nothing.
/// The first rank owns a run unless the mesh is empty.
class VertexPart {
 public:
  /// Vertices in a block: wide enough for fast products, while ADMM's data of a block fit in a
  /// megabyte of cache.
  static constexpr Eigen::Index kBlock = 192;
  /// Enough runs for 64 ranks or threads, but few enough to keep results of each.
  static constexpr int kMostRuns = 64;

  VertexPart() = default;
  /// Part of a mesh of `mesh_vertices` vertices. Throws std::invalid_argument unless 0 <= rank <
  /// ranks.
  explicit VertexPart(Eigen::Index mesh_vertices, int rank = 0, int ranks = 1);

  /// Number of vertices N of the mesh.
  Eigen::Index mesh_vertices() const { return mesh_vertices_; }
  int mesh_runs() const { return mesh_runs_; }
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }

  /// Runs, blocks and vertices of the mesh that this rank owns, each consecutive.
  const IndexRange& runs() const { return runs_; }
  int blocks() const { return blocks_.count(); }
  Eigen::Index first() const { return blocks_.first * kBlock; }
  Eigen::Index vertices() const;

  /// First vertex of the rank's block b, counted from first(), and its number of vertices.
  Eigen::Index first_of(int b) const { return b * kBlock; }
  Eigen::Index size_of(int b) const { return std::min(kBlock, vertices() - first_of(b)); }

  /// Blocks of one of the rank's runs, counted from its first block.
  IndexRange blocks_of(int run) const;
  int owner(VertexIndex vertex) const;

 private:
  int mesh_blocks() const;
  IndexRange mesh_blocks_of(int run) const;

  Eigen::Index mesh_vertices_ = 0;
  int rank_ = 0;
  int ranks_ = 1;
  int mesh_runs_ = 0;
  IndexRange runs_;
  IndexRange blocks_;
};

/// Sequence of the vertices that a rank owns. \pre the sequence outlives it
std::shared_ptr<const FrameSource> own_vertices(const FrameSource& sequence,
                                                const VertexPart& part);

/// A rank's part of a sequence; it keeps references.
struct SequencePart {
  const Positions& rest;       ///< all vertices of the mesh, N x 3
  const Triangles& triangles;  ///< whole mesh, M x 3
  const FrameSource& frames;   ///< F poses of the n vertices of the rank's VertexPart
};

/// Sums, maxima and copies over all vertices of a mesh: every step of the decomposition that
/// involves more than one vertex.
///
/// Each run of vertices (VertexPart) gives a matrix, which the rank that owns the run computes.
/// Context::sum() joins the matrices, so results have the same bits for any number of threads, and
/// of ranks with processors of one kind. Ranks send each other matrices of complete nodes. Each
/// rank except the first sends one if there are 2, 4, 8 ... ranks and 64 runs, otherwise some more.
///
/// If a passed function throws on one rank only (std::bad_alloc, or `compute` of on()), the other
/// ranks wait for it. A caller that stops one rank must stop all.
class Reduction {
 public:
  using OfRun = Context::OfRun;
  using Join = Context::Join;
  using Compute = std::function<Eigen::MatrixXd()>;

  /// This rank's part of the `vertices` of a mesh. Keeps the context without its progress function,
  /// because one step of a computation may take many of these calls.
  explicit Reduction(Eigen::Index vertices, const Context& context = {});

  const VertexPart& part() const { return part_; }
  const Context& context() const { return context_; }
  /// Whether this rank receives the results of joined(), sum() and largest().
  bool is_first() const { return part_.rank() == 0; }

  /// Context::sum() over all runs of the mesh; calls `of_run` for each of part().runs().
  Eigen::MatrixXd joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                         const Join& join) const;
  Eigen::MatrixXd sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;
  /// Largest value of each entry over all runs, by joined().
  Eigen::MatrixXd largest(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;

  /// Result of `compute` on one rank, copied to all ranks. Use it for factorizations, because ranks
  /// on processors of other kinds may round differently.
  Eigen::MatrixXd on(int rank, const Compute& compute) const;
  Eigen::MatrixXd on_first(const Compute& compute) const { return on(0, compute); }
  /// Copies a matrix of the first rank (0 x 0 on the others) to all ranks.
  Eigen::MatrixXd everywhere(Eigen::MatrixXd of_first) const;

  /// Vertex with the largest value in each of `count` rows, on all ranks. Ties (kNearTie) go to the
  /// lowest vertex; -1 if no value is positive. `values` returns the values of one of the rank's
  /// blocks, count x n. It is called once per block, from several threads.
  std::vector<VertexIndex> argmax(int count,
                                  const std::function<Eigen::MatrixXd(int block)>& values) const;

 private:
  VertexPart part_;
  Context context_;
};

/// Vertex with the largest product of `energies` (N) and `weights` (N, or empty for ones). Ties
/// (kNearTie) go to the lowest vertex; -1 if no product is positive.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights = {});

/// Same for a rank that has only the `energies` and `weights` of its own n vertices. Returns a
/// vertex of the mesh, on all ranks.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights, const Reduction& reduction);

/// Squared length of each vertex's displacement (N) in one component (3N).
Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component);

}  // namespace mimetra
