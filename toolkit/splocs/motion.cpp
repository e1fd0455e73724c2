#include "toolkit/splocs/motion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Bytes of frames that are read at once for a block.
constexpr Eigen::Index kReadBytes = Eigen::Index{1} << 20;

template <typename Block>
auto numbers_of(Block& block) {
  return std::span(block.data(), static_cast<std::size_t>(block.size()));
}

/// Displacements of vertices `first` .. first + m - 1 of `poses` (R x 3n) from `rest` (m x 3).
VertexBlocks<double>::Block displaced(const Eigen::Map<const Frames>& poses, Eigen::Index first,
                                      const Eigen::Ref<const Positions>& rest) {
  VertexBlocks<double>::Block rows(poses.rows(), rest.size());
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const PositionsView pose(poses.row(row).data() + 3 * first, rest.rows(), 3);
    VertexBlocks<double>::by_vertex(rows, row) = pose - rest;
  }
  return rows;
}

/// Reuses the memory of blocks for later blocks of the same shape. Otherwise the C library requests
/// blocks above 32 MB from the system each time, which clears them page by page.
template <typename Scalar>
class BlockPool {
 public:
  using Block = typename BlockSource<Scalar>::Block;

  /// Block with arbitrary values. Safe to call from several threads.
  std::shared_ptr<Block> block(Eigen::Index rows, Eigen::Index columns) const {
    std::unique_ptr<Block> block;
    {
      const std::scoped_lock lock(unused_->mutex);
      const auto found = std::ranges::find_if(unused_->blocks, [&](const auto& unused) {
        return unused->rows() == rows && unused->cols() == columns;
      });
      if (found == unused_->blocks.end()) {
        // Reserve room for its return, which must not fail.
        unused_->blocks.reserve(++unused_->made);
      } else {
        block = std::move(*found);
        unused_->blocks.erase(found);
      }
    }
    if (!block) block = std::make_unique<Block>(rows, columns);
    return {block.release(), [unused = unused_](Block* released) {
              const std::scoped_lock lock(unused->mutex);
              unused->blocks.emplace_back(released);
            }};
  }

 private:
  struct Unused {
    std::mutex mutex;
    std::vector<std::unique_ptr<Block>> blocks;
    std::size_t made = 0;
  };
  /// Blocks may outlive the pool.
  std::shared_ptr<Unused> unused_ = std::make_shared<Unused>();
};

/// Blocks in a ScratchFile, one after the other, each in row order.
template <typename Scalar>
class ScratchBlocks : public KeptBlocks<Scalar> {
 public:
  using typename BlockSource<Scalar>::Block;

  /// Throws OutputError.
  ScratchBlocks(Eigen::Index row_count, const VertexPart& part)
      : KeptBlocks<Scalar>(row_count, part) {}

  std::shared_ptr<const Block> block(int b) const override { return read(b); }
  void put_rows(int b, Eigen::Index row, const Block& values) override {
    file_.write(byte_of(b, row), std::as_bytes(numbers_of(values)));
  }
  void put(int b, Block block) override { put_rows(b, 0, block); }
  void change(int b, const std::function<void(Block&)>& change) override {
    const auto block = read(b);
    change(*block);
    put_rows(b, 0, *block);
  }
  void release(int) override {}

 private:
  std::shared_ptr<Block> read(int b) const {
    auto block = pool_.block(this->rows(), 3 * this->size(b));
    file_.read(byte_of(b, 0), std::as_writable_bytes(numbers_of(*block)));
    return block;
  }
  std::size_t byte_of(int b, Eigen::Index row) const {
    const Eigen::Index before = this->rows() * 3 * this->first(b) + row * 3 * this->size(b);
    return sizeof(Scalar) * static_cast<std::size_t>(before);
  }

  ScratchFile file_;
  BlockPool<Scalar> pool_;
};

/// Displacements that are read again for each use.
class SequenceBlocks : public BlockSource<double> {
 public:
  SequenceBlocks(const SequencePart& sequence, const VertexPart& part, double scale)
      : BlockSource(sequence.frames.frames(), part), sequence_(sequence), scale_(scale) {}

  std::shared_ptr<const Block> block(int b) const override {
    const Eigen::Index vertex = first(b), columns = 3 * size(b);
    const auto rest = sequence_.rest.middleRows(part().first() + vertex, size(b));
    const Eigen::Index at_once =
        std::max<Eigen::Index>(1, kReadBytes / static_cast<Eigen::Index>(sizeof(double)) / columns);
    auto block = pool_.block(rows(), columns);
    Frames poses(std::min(at_once, rows()), columns);
    for (Eigen::Index frame = 0; frame < rows(); frame += at_once) {
      const Eigen::Index count = std::min(at_once, rows() - frame);
      sequence_.frames.read_vertices(static_cast<int>(frame), static_cast<VertexIndex>(vertex),
                                     FramesView(poses.data(), count, columns));
      block->middleRows(frame, count) =
          displaced(Eigen::Map<const Frames>(poses.data(), count, columns), 0, rest) / scale_;
    }
    return block;
  }

 private:
  SequencePart sequence_;
  double scale_;
  BlockPool<double> pool_;
};

}  // namespace

template <typename Scalar>
std::unique_ptr<KeptBlocks<Scalar>> kept_blocks(MotionPlace place, Eigen::Index rows,
                                                const VertexPart& part) {
  if (place == MotionPlace::scratch) return std::make_unique<ScratchBlocks<Scalar>>(rows, part);
  auto blocks = std::make_unique<VertexBlocks<Scalar>>(rows, part);
  for (int b = 0; b < blocks->count(); ++b) (*blocks)[b].resize(rows, 3 * blocks->size(b));
  return blocks;
}

template std::unique_ptr<KeptBlocks<double>> kept_blocks(MotionPlace, Eigen::Index,
                                                         const VertexPart&);
template std::unique_ptr<KeptBlocks<float>> kept_blocks(MotionPlace, Eigen::Index,
                                                        const VertexPart&);

std::unique_ptr<BlockSource<double>> read_displacements(const SequencePart& sequence,
                                                        const VertexPart& part, double scale) {
  return std::make_unique<SequenceBlocks>(sequence, part, scale);
}

std::unique_ptr<KeptBlocks<double>> kept_displacements(const SequencePart& sequence,
                                                       const VertexPart& part, MotionPlace place,
                                                       const Context& context) {
  auto blocks = kept_blocks<double>(place, sequence.frames.frames(), part);
  const auto put_frames = [&](int first, int count) {
    const FrameBlock frames(sequence.frames, first, count);
    for (int b = 0; b < blocks->count(); ++b) {
      const auto rest = sequence.rest.middleRows(part.first() + blocks->first(b), blocks->size(b));
      blocks->put_rows(b, first, displaced(frames.poses(), blocks->first(b), rest));
    }
  };
  for_each_run(sequence.frames, put_frames, context);
  return blocks;
}

namespace {

/// Spread of a frame's displacement coordinates over some vertices: one column each.
enum SpreadColumn {
  kMean,
  kSquares,   ///< sum of squared differences from the mean
  kFurthest,  ///< length of the longest displacement
  kCount,     ///< number of coordinates
  kInfinite,  ///< 1 if a coordinate is not a finite number, otherwise 0
  kSpreadColumns
};

/// Joins the spreads of two sets: the sum of squares about their common mean follows from both
/// without cancellation.
///
/// [Chan, Golub, LeVeque. Updating Formulae and a Pairwise Algorithm for Computing Sample
/// Variances. COMPSTAT 1982]
void join_spreads(Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  const Eigen::ArrayXd both = left.col(kCount) + right.col(kCount);
  const Eigen::ArrayXd difference = right.col(kMean) - left.col(kMean);
  const Eigen::ArrayXd share = right.col(kCount).array() / both;
  left.col(kSquares).array() +=
      right.col(kSquares).array() + difference.square() * share * left.col(kCount).array();
  left.col(kMean).array() += difference * share;
  left.col(kFurthest) = left.col(kFurthest).cwiseMax(right.col(kFurthest));
  left.col(kCount) = both;
  left.col(kInfinite) = left.col(kInfinite).cwiseMax(right.col(kInfinite));
}

/// Spread of each frame over the vertices of a block (F x 3m).
Eigen::MatrixXd spreads_of(const VertexBlocks<double>::Block& displacements) {
  Eigen::MatrixXd spreads(displacements.rows(), kSpreadColumns);
  for (Eigen::Index f = 0; f < displacements.rows(); ++f) {
    const auto row = displacements.row(f).array();
    const double mean = row.mean(), squares = (row - mean).square().sum();
    const Eigen::Index m = row.size() / 3;
    const double furthest2 =
        (row.segment(0, m).square() + row.segment(m, m).square() + row.segment(2 * m, m).square())
            .maxCoeff();
    const bool infinite = !std::isfinite(squares) && !row.allFinite();
    spreads.row(f) << mean, squares, std::sqrt(furthest2), static_cast<double>(row.size()),
        infinite ? 1.0 : 0.0;
  }
  return spreads;
}

/// Spread of each frame over the mesh (F x kSpreadColumns), on all ranks.
Eigen::MatrixXd spreads_of(const BlockSource<double>& X, const Reduction& reduction) {
  const auto of_run = [&](int run, Eigen::MatrixXd& spreads) {
    const IndexRange blocks = reduction.part().blocks_of(run);
    spreads = spreads_of(*X.block(blocks.first));
    for (int b = blocks.first + 1; b < blocks.end; ++b) {
      join_spreads(spreads, spreads_of(*X.block(b)));
    }
  };
  return reduction.everywhere(reduction.joined(X.rows(), kSpreadColumns, of_run, join_spreads));
}

void require_finite(const Eigen::MatrixXd& spreads) {
  for (Eigen::Index f = 0; f < spreads.rows(); ++f) {
    if (std::isfinite(spreads(f, kSquares))) continue;
    throw std::invalid_argument(
        "frame " + std::to_string(f) +
        (spreads(f, kInfinite) == 0
             ? " is so far from the rest pose that its energy is not a finite number"
             : " has a coordinate that is not a finite number"));
  }
}

/// \pre finite spreads
void require_motion(const Positions& rest, const Eigen::MatrixXd& spreads) {
  const double furthest = spreads.col(kFurthest).maxCoeff();
  const double size = diameter(rest);
  if (furthest > kLeastMotion * size) return;
  std::string found =
      "nothing moves: all " + std::to_string(spreads.rows()) + " frames are the rest pose";
  if (furthest > 0) {
    found += " to " + readable(furthest) + ", " + readable(furthest / size) + " of its diameter";
  }
  throw MismatchError(found + "; expected motion above " + readable(kLeastMotion) +
                      " of its diameter, " + readable(size) +
                      ": give frames that deform (head motion that is taken out is none)");
}

/// Scale of displacement coordinates with this mean and variance.
double scale_of(MotionScale unit, double mean, double variance) {
  switch (unit) {
    case MotionScale::root_mean_square:
      return std::sqrt(variance + mean * mean);
    case MotionScale::standard_deviation:
      break;
  }
  return std::sqrt(variance);
}

}  // namespace

Motion scaled_motion(const SequencePart& sequence, MotionScale unit, const Reduction& reduction,
                     MotionPlace place) {
  const VertexPart& part = reduction.part();
  std::unique_ptr<KeptBlocks<double>> kept;
  if (place != MotionPlace::sequence) {
    kept = kept_displacements(sequence, part, place, reduction.context());
  }
  const Eigen::MatrixXd spreads =
      spreads_of(kept ? *kept : *read_displacements(sequence, part), reduction);
  require_finite(spreads);
  require_motion(sequence.rest, spreads);
  const auto coordinates = static_cast<double>(sequence.rest.size());
  const auto frames = static_cast<double>(spreads.rows());
  double mean = 0;
  for (const double of_frame : spreads.col(kMean)) mean += of_frame / frames;
  double squares = 0;
  for (const auto& spread : spreads.rowwise()) {
    squares += spread[kSquares] + coordinates * (spread[kMean] - mean) * (spread[kMean] - mean);
  }
  const double variance = squares / coordinates / frames;
  const double scale = scale_of(unit, mean, variance);
  if (scale == 0) {
    throw MismatchError("nothing moves: all " + std::to_string(spreads.rows()) +
                        " frames are the rest pose, shifted by one amount along x, y and z");
  }
  const double norm2 = coordinates * frames * ((variance + mean * mean) / scale / scale);
  if (!std::isfinite(norm2)) {
    throw std::invalid_argument(
        "the frames are so far from the rest pose that their energy is not a finite number");
  }
  if (!kept) {
    return {read_displacements(sequence, part, scale), nullptr, scale, norm2};
  }
  const auto divide = [&kept, scale](int b) {
    kept->change(b, [scale](KeptBlocks<double>::Block& block) { block /= scale; });
  };
  parallel_for(kept->count(), divide, reduction.context());
  KeptBlocks<double>* const blocks = kept.get();
  return {std::move(kept), blocks, scale, norm2};
}

}  // namespace mimetra
