#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "toolkit/mesh/scratch_file.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/splocs/vertex_blocks.h"

/// Blocks of a motion that is larger than memory. Internal to the decomposition.
namespace mimetra {

/// Memory of blocks that are read, for the next ones of the same shape: what is larger than 32 MB
/// the C library would ask of the system each time, which clears it page by page.
template <typename Scalar>
class BlockPool {
 public:
  using Block = typename BlockSource<Scalar>::Block;

  /// Numbers of any value. From several threads.
  std::shared_ptr<Block> block(Eigen::Index rows, Eigen::Index columns) const;

 private:
  struct Unused {
    std::mutex mutex;
    std::vector<std::unique_ptr<Block>> blocks;
    std::size_t made = 0;
  };
  /// Blocks may outlive the pool.
  std::shared_ptr<Unused> unused_ = std::make_shared<Unused>();
};

/// Blocks in a ScratchFile, one after the other, each row after row.
template <typename Scalar>
class ScratchBlocks : public KeptBlocks<Scalar> {
 public:
  using typename BlockSource<Scalar>::Block;

  /// Throws OutputError.
  ScratchBlocks(Eigen::Index row_count, const VertexPart& part)
      : KeptBlocks<Scalar>(row_count, part) {}

  std::shared_ptr<const Block> block(int b) const override { return read(b); }
  void put_rows(int b, Eigen::Index row, const Block& values) override;
  void put(int b, Block block) override { put_rows(b, 0, block); }
  void change(int b, const std::function<void(Block&)>& change) override;
  void release(int) override {}

 private:
  std::shared_ptr<Block> read(int b) const;
  std::size_t byte_of(int b, Eigen::Index row) const;

  ScratchFile file_;
  BlockPool<Scalar> pool_;
};

/// Blocks with memory, or in a file. \pre the place is one of the two
template <typename Scalar>
std::unique_ptr<KeptBlocks<Scalar>> kept_blocks(MotionPlace place, Eigen::Index rows,
                                                const VertexPart& part);

/// Displacements of a part of a sequence from its rest pose, divided by `scale`, read anew for each
/// use. The sequence outlives it.
class SequenceBlocks : public BlockSource<double> {
 public:
  SequenceBlocks(const SequencePart& sequence, const VertexPart& part, double scale = 1);

  std::shared_ptr<const Block> block(int b) const override;

 private:
  SequencePart sequence_;
  double scale_;
  BlockPool<double> pool_;
};

/// Displacements of a part of a sequence from its rest pose (F x 3n). Throws what reading throws,
/// OutputError. \pre as kept_blocks()
std::unique_ptr<KeptBlocks<double>> kept_displacements(const SequencePart& sequence,
                                                       const VertexPart& part, MotionPlace place,
                                                       const Context& = {});

}  // namespace mimetra
