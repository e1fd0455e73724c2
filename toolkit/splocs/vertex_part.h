#pragma once

#include <algorithm>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"

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

}  // namespace mimetra
