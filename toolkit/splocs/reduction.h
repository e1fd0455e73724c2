#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Which vertices of a mesh one of several ranks works on.
///
/// The mesh's vertices are cut into blocks, these into runs, and each rank owns some runs that
/// follow each other. Blocks and runs depend on nothing but the mesh's number of vertices, so that
/// what is computed run by run is the same for every number of ranks. A rank owns nothing where
/// there are more ranks than runs; the first one owns a run wherever there is one.
class VertexPart {
 public:
  /// Vertices in a block: wide products, and all that ADMM needs of them in a megabyte of cache.
  static constexpr Eigen::Index kBlock = 192;
  /// Enough for as many ranks or threads to work, few for what is kept of each.
  static constexpr int kMostRuns = 64;

  VertexPart() = default;
  /// Of a mesh of so many vertices. Throws std::invalid_argument unless 0 <= rank < ranks.
  explicit VertexPart(Eigen::Index mesh_vertices, int rank = 0, int ranks = 1);

  /// N.
  Eigen::Index mesh_vertices() const { return mesh_vertices_; }
  int mesh_runs() const { return mesh_runs_; }
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }

  /// What this rank owns: some of the mesh's runs, of its blocks, and of its vertices, in order.
  const IndexRange& runs() const { return runs_; }
  int blocks() const { return blocks_.count(); }
  Eigen::Index first() const { return blocks_.first * kBlock; }
  Eigen::Index vertices() const;

  /// First vertex of own block b, counted from first(), and its number of vertices.
  Eigen::Index first_of(int b) const { return b * kBlock; }
  Eigen::Index size_of(int b) const { return std::min(kBlock, vertices() - first_of(b)); }

  /// Blocks of one of the own runs, counted from the first own block.
  IndexRange blocks_of(int run) const;
  /// Rank that owns a vertex of the mesh.
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

/// The vertices of a sequence that a rank owns. \pre the sequence outlives it
std::shared_ptr<const FrameSource> own_vertices(const FrameSource& sequence,
                                                const VertexPart& part);

/// What one rank holds of a sequence; it keeps references.
struct SequencePart {
  const Positions& rest;       ///< of all vertices of the mesh, N x 3
  const Triangles& triangles;  ///< of the mesh, M x 3
  const FrameSource& frames;   ///< F poses of the n vertices of the rank's VertexPart
};

/// Sums, largest values and copies over all vertices of a mesh: all that the decomposition needs
/// beyond one vertex.
///
/// Each run of vertices (VertexPart) gives a matrix, which the rank that owns the run computes.
/// Context::sum() joins the matrices, so results have the same bits for any number of threads, and
/// of ranks on processors of one kind. Ranks send each other matrices of complete nodes: each rank
/// but the first sends one if there are 2, 4, 8 ... ranks and 64 runs, otherwise some more.
///
/// If a function that is given to one of these calls throws on one rank only (std::bad_alloc, or
/// `compute` of on()), the other ranks wait for it: a caller that stops one must stop all.
class Reduction {
 public:
  using OfRun = Context::OfRun;
  using Join = Context::Join;
  using Compute = std::function<Eigen::MatrixXd()>;

  /// This rank's part of the `vertices` of a mesh. Keeps the context but for its progress, since
  /// one step of a computation may take many of these calls.
  explicit Reduction(Eigen::Index vertices, const Context& context = {});

  const VertexPart& part() const { return part_; }
  const Context& context() const { return context_; }
  /// Whether this is the rank that has the results of joined(), sum() and largest().
  bool is_first() const { return part_.rank() == 0; }

  /// Context::sum() over all runs of the mesh: `of_run` is called for each of part().runs().
  Eigen::MatrixXd joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                         const Join& join) const;
  Eigen::MatrixXd sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;
  /// joined() by taking the larger number of two.
  Eigen::MatrixXd largest(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;

  /// What `compute` gives on one rank, on all of them. Factorizations belong here: ranks on
  /// processors of other kinds need not round alike.
  Eigen::MatrixXd on(int rank, const Compute& compute) const;
  Eigen::MatrixXd on_first(const Compute& compute) const { return on(0, compute); }
  /// What only the first rank has (0 x 0 elsewhere), on all of them.
  Eigen::MatrixXd everywhere(Eigen::MatrixXd of_first) const;

  /// Vertex with the largest of its values, in each of `count` rows: the lowest of those that tie
  /// (kNearTie); -1 where no value is above 0. `values` gives those of an own block, count x n; it
  /// is asked once for each, from several threads. On all ranks.
  std::vector<VertexIndex> argmax(int count,
                                  const std::function<Eigen::MatrixXd(int block)>& values) const;

 private:
  VertexPart part_;
  Context context_;
};

/// Vertex (of N) where the entry of `energies` (N) is largest, each times its entry of `weights`
/// (N, or empty for ones), the lowest of those that tie (kNearTie); -1 where no product
/// is above zero.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights = {});

/// The same, where a rank has the `energies` and `weights` of its vertices only (n). The vertex is
/// one of the mesh, on all ranks.
VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights, const Reduction& reduction);

/// Squared length of each vertex's displacement in one component (3N): N.
Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component);

}  // namespace mimetra
