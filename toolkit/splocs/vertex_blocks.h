#pragma once

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "toolkit/splocs/reduction.h"

namespace mimetra {

/// Displacements of the n vertices that a rank owns (R x 3n), cut into blocks of vertices that fit
/// in a core's cache. A single rank owns all vertices of the mesh. Derived classes decide where
/// blocks are kept; they may exceed the memory.
template <typename Scalar>
class BlockSource {
 public:
  /// R x 3m: x of the block's m vertices, then y, then z, side by side for vector instructions.
  using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  virtual ~BlockSource() = default;

  Eigen::Index rows() const { return rows_; }
  const VertexPart& part() const { return part_; }
  /// Number of vertices n.
  Eigen::Index vertices() const { return part_.vertices(); }
  int count() const { return part_.blocks(); }
  /// First vertex and number of vertices of block b, as in the part.
  Eigen::Index first(int b) const { return part_.first_of(b); }
  Eigen::Index size(int b) const { return part_.size_of(b); }
  Block zero_block(int b) const { return Block::Zero(rows_, 3 * size(b)); }

  /// Block b as kept in memory, or read for the caller. Safe to call from several threads. Throws
  /// whatever reading throws.
  virtual std::shared_ptr<const Block> block(int b) const = 0;

  /// A row of `block` as m x 3, with one vertex per row.
  static auto by_vertex(Block& block, Eigen::Index row) {
    return Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                block.cols() / 3, 3);
  }
  static auto by_vertex(const Block& block, Eigen::Index row) {
    return Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 3>>(block.row(row).data(),
                                                                      block.cols() / 3, 3);
  }

  /// All rows of vertex v of the mesh (R x 3). \pre the rank owns it
  Eigen::Matrix<Scalar, Eigen::Dynamic, 3> vertex(VertexIndex v) const {
    const Eigen::Index place = v - part_.first();
    const int b = static_cast<int>(place / VertexPart::kBlock);
    return (*block(b))(Eigen::all, Eigen::seqN(place - first(b), 3, size(b)));
  }

 protected:
  BlockSource() = default;
  BlockSource(Eigen::Index rows, const VertexPart& part) : rows_(rows), part_(part) {}
  BlockSource(const BlockSource&) = default;
  BlockSource(BlockSource&&) noexcept = default;
  BlockSource& operator=(const BlockSource&) = default;
  BlockSource& operator=(BlockSource&&) noexcept = default;

 private:
  Eigen::Index rows_ = 0;
  VertexPart part_;
};

/// Blocks that can be changed. Several threads may change different blocks, or different rows of a
/// block.
template <typename Scalar>
class KeptBlocks : public BlockSource<Scalar> {
 public:
  using typename BlockSource<Scalar>::Block;

  /// Writes `values` to rows of block b, from `row` on.
  virtual void put_rows(int b, Eigen::Index row, const Block& values) = 0;
  virtual void put(int b, Block block) = 0;
  /// Calls `change` with block b, and keeps the changed block.
  virtual void change(int b, const std::function<void(Block&)>& change) = 0;
  /// Frees block b, which is not needed any more.
  virtual void release(int b) = 0;

 protected:
  using BlockSource<Scalar>::BlockSource;
};

/// Blocks in memory.
template <typename Scalar>
class VertexBlocks : public KeptBlocks<Scalar> {
 public:
  using typename BlockSource<Scalar>::Block;
  using BlockSource<Scalar>::rows, BlockSource<Scalar>::count, BlockSource<Scalar>::first,
      BlockSource<Scalar>::size, BlockSource<Scalar>::vertices, BlockSource<Scalar>::by_vertex,
      BlockSource<Scalar>::zero_block;

  VertexBlocks() = default;
  /// Blocks without memory, to be filled one by one.
  VertexBlocks(Eigen::Index row_count, const VertexPart& part)
      : KeptBlocks<Scalar>(row_count, part), blocks_(part.blocks()) {}
  /// All vertices of a mesh, from `frames` (R x 3N).
  explicit VertexBlocks(const Frames& frames)
      : VertexBlocks(frames.rows(), VertexPart(frames.cols() / 3)) {
    for (int b = 0; b < count(); ++b) {
      Block& block = blocks_[b] = zero_block(b);
      for (Eigen::Index row = 0; row < rows(); ++row) {
        by_vertex(block, row) = PositionsView(frames.row(row).data(), vertices(), 3)
                                    .middleRows(first(b), size(b))
                                    .template cast<Scalar>();
      }
    }
  }

  Block& operator[](int b) { return blocks_[b]; }
  const Block& operator[](int b) const { return blocks_[b]; }

  /// \pre this object outlives the block
  std::shared_ptr<const Block> block(int b) const override {
    return {std::shared_ptr<const Block>(), &blocks_[b]};
  }
  /// \pre the block has memory
  void put_rows(int b, Eigen::Index row, const Block& values) override {
    blocks_[b].middleRows(row, values.rows()) = values;
  }
  void put(int b, Block block) override { blocks_[b] = std::move(block); }
  void change(int b, const std::function<void(Block&)>& change) override { change(blocks_[b]); }
  void release(int b) override { blocks_[b].resize(0, 0); }

  /// Displacements as R x 3n.
  Frames frames() const {
    Frames frames(rows(), 3 * vertices());
    for (int b = 0; b < count(); ++b) {
      for (Eigen::Index row = 0; row < rows(); ++row) {
        Eigen::Map<Positions>(frames.row(row).data(), vertices(), 3).middleRows(first(b), size(b)) =
            by_vertex(blocks_[b], row).template cast<double>();
      }
    }
    return frames;
  }

  /// Blocks in another precision; each block is released once it is converted.
  template <typename Other>
  VertexBlocks<Other> cast() && {
    VertexBlocks<Other> result(rows(), this->part());
    for (int b = 0; b < count(); ++b) {
      if constexpr (std::is_same_v<Other, Scalar>) {
        result[b] = std::move(blocks_[b]);
      } else {
        result[b] = blocks_[b].template cast<Other>();
        release(b);
      }
    }
    return result;
  }

 private:
  std::vector<Block> blocks_;
};

}  // namespace mimetra
