#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "toolkit/splocs/vertex_part.h"

namespace mimetra {

/// Displacements of the n vertices that a rank owns in R rows (R x 3n), cut into blocks of
/// vertices, so that what happens to one block happens in a core's cache. On one rank they are all
/// vertices of the mesh. Internal to the decomposition.
template <typename Scalar>
class VertexBlocks {
 public:
  /// R x 3m: x of the block's m vertices, then y, then z, side by side for vector instructions.
  using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  VertexBlocks() = default;
  /// Blocks without memory, for whoever fills them one by one.
  VertexBlocks(Eigen::Index rows, const VertexPart& part)
      : rows_(rows), part_(part), blocks_(part.blocks()) {}
  /// All vertices of a mesh, from R x 3N.
  explicit VertexBlocks(const Frames& rows)
      : VertexBlocks(rows.rows(), VertexPart(rows.cols() / 3)) {
    for (int b = 0; b < count(); ++b) {
      Block& block = blocks_[b] = zero_block(b);
      for (Eigen::Index row = 0; row < rows_; ++row) {
        by_vertex(block, row) = PositionsView(rows.row(row).data(), vertices(), 3)
                                    .middleRows(first(b), size(b))
                                    .template cast<Scalar>();
      }
    }
  }

  Eigen::Index rows() const { return rows_; }
  const VertexPart& part() const { return part_; }
  /// n.
  Eigen::Index vertices() const { return part_.vertices(); }
  int count() const { return static_cast<int>(blocks_.size()); }
  /// As first_of() and size_of() of the part.
  Eigen::Index first(int b) const { return part_.first_of(b); }
  Eigen::Index size(int b) const { return part_.size_of(b); }

  Block& operator[](int b) { return blocks_[b]; }
  const Block& operator[](int b) const { return blocks_[b]; }
  Block zero_block(int b) const { return Block::Zero(rows_, 3 * size(b)); }

  /// A row of `block` with one vertex a row, m x 3.
  static auto by_vertex(Block& block, Eigen::Index row) {
    return Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                block.cols() / 3, 3);
  }
  static auto by_vertex(const Block& block, Eigen::Index row) {
    return Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                      block.cols() / 3, 3);
  }

  /// All rows of one vertex of the mesh (R x 3). \pre the rank owns it
  Eigen::Matrix<Scalar, Eigen::Dynamic, 3> vertex(VertexIndex v) const {
    const Eigen::Index place = v - part_.first();
    const int b = static_cast<int>(place / VertexPart::kBlock);
    return blocks_[b](Eigen::all, Eigen::seqN(place - first(b), 3, size(b)));
  }

  /// As R x 3n.
  Frames frames() const {
    Frames frames(rows_, 3 * vertices());
    for (int b = 0; b < count(); ++b) {
      for (Eigen::Index row = 0; row < rows_; ++row) {
        Eigen::Map<Positions>(frames.row(row).data(), vertices(), 3).middleRows(first(b), size(b)) =
            by_vertex(blocks_[b], row).template cast<double>();
      }
    }
    return frames;
  }

  /// In another precision; each block is released once it is taken over.
  template <typename Other>
  VertexBlocks<Other> cast() && {
    VertexBlocks<Other> result(rows_, part_);
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
  VertexPart part_;
  std::vector<Block> blocks_;
};

}  // namespace mimetra
