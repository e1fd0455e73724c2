#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Displacements of all vertices in R rows (R x 3N), cut into blocks of vertices, so that what
/// happens to one block happens in a core's cache. Internal to the decomposition.
template <typename Scalar>
class VertexBlocks {
 public:
  /// R x 3n: x of the block's n vertices, then y, then z, side by side for vector instructions.
  using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Vertices in a block: wide products, and all that ADMM needs of them in a megabyte of cache.
  /// Fixed, so that sums round the same for every number of threads.
  static constexpr Eigen::Index kVertices = 192;

  VertexBlocks() = default;
  /// Blocks without memory, for whoever fills them one by one.
  VertexBlocks(Eigen::Index rows, Eigen::Index vertices)
      : rows_(rows), vertices_(vertices), blocks_((vertices + kVertices - 1) / kVertices) {}
  /// From R x 3N.
  explicit VertexBlocks(const Frames& rows) : VertexBlocks(rows.rows(), rows.cols() / 3) {
    for (int b = 0; b < count(); ++b) {
      Block& block = blocks_[b] = zero_block(b);
      for (Eigen::Index row = 0; row < rows_; ++row) {
        by_vertex(block, row) = PositionsView(rows.row(row).data(), vertices_, 3)
                                    .middleRows(first(b), size(b))
                                    .template cast<Scalar>();
      }
    }
  }

  Eigen::Index rows() const { return rows_; }
  Eigen::Index vertices() const { return vertices_; }
  int count() const { return static_cast<int>(blocks_.size()); }
  /// First vertex of block b, and its number of vertices.
  Eigen::Index first(int b) const { return b * kVertices; }
  Eigen::Index size(int b) const { return std::min(kVertices, vertices_ - first(b)); }

  Block& operator[](int b) { return blocks_[b]; }
  const Block& operator[](int b) const { return blocks_[b]; }
  Block zero_block(int b) const { return Block::Zero(rows_, 3 * size(b)); }

  /// A row of `block` with one vertex a row, n x 3.
  static auto by_vertex(Block& block, Eigen::Index row) {
    return Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                block.cols() / 3, 3);
  }
  static auto by_vertex(const Block& block, Eigen::Index row) {
    return Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                      block.cols() / 3, 3);
  }

  /// All rows of one vertex (R x 3).
  Eigen::Matrix<Scalar, Eigen::Dynamic, 3> vertex(VertexIndex v) const {
    const int b = static_cast<int>(v / kVertices);
    return blocks_[b](Eigen::all, Eigen::seqN(v - first(b), 3, size(b)));
  }

  /// As R x 3N.
  Frames frames() const {
    Frames frames(rows_, 3 * vertices_);
    for (int b = 0; b < count(); ++b) {
      for (Eigen::Index row = 0; row < rows_; ++row) {
        Eigen::Map<Positions>(frames.row(row).data(), vertices_, 3).middleRows(first(b), size(b)) =
            by_vertex(blocks_[b], row).template cast<double>();
      }
    }
    return frames;
  }

  /// In another precision; each block is released once it is taken over.
  template <typename Other>
  VertexBlocks<Other> cast() && {
    VertexBlocks<Other> result(rows_, vertices_);
    for (int b = 0; b < count(); ++b) {
      if constexpr (std::is_same_v<Other, Scalar>) {
        result[b] = std::move(blocks_[b]);
      } else {
        result[b] = blocks_[b].template cast<Other>();
        blocks_[b].resize(0, 0);
      }
    }
    return result;
  }

 private:
  Eigen::Index rows_ = 0;
  Eigen::Index vertices_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace mimetra
