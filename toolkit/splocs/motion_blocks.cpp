#include "toolkit/splocs/motion_blocks.h"

#include <algorithm>
#include <span>
#include <utility>

namespace mimetra {
namespace {

/// Bytes of frames that are read at once for a block.
constexpr Eigen::Index kReadBytes = Eigen::Index{1} << 20;

template <typename Block>
auto numbers_of(Block& block) {
  return std::span(block.data(), static_cast<std::size_t>(block.size()));
}

/// Of vertices `first` .. first + m - 1 of poses (R x 3n), from the same of the rest pose.
VertexBlocks<double>::Block displaced(const Eigen::Map<const Frames>& poses, Eigen::Index first,
                                      const Eigen::Ref<const Positions>& rest) {
  VertexBlocks<double>::Block rows(poses.rows(), rest.size());
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const PositionsView pose(poses.row(row).data() + 3 * first, rest.rows(), 3);
    VertexBlocks<double>::by_vertex(rows, row) = pose - rest;
  }
  return rows;
}

}  // namespace

template <typename Scalar>
std::shared_ptr<typename BlockPool<Scalar>::Block> BlockPool<Scalar>::block(
    Eigen::Index rows, Eigen::Index columns) const {
  std::unique_ptr<Block> block;
  {
    const std::scoped_lock lock(unused_->mutex);
    const auto found = std::ranges::find_if(unused_->blocks, [&](const auto& unused) {
      return unused->rows() == rows && unused->cols() == columns;
    });
    if (found == unused_->blocks.end()) {
      // Room for its return, which must not fail.
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

template <typename Scalar>
std::size_t ScratchBlocks<Scalar>::byte_of(int b, Eigen::Index row) const {
  const Eigen::Index before = this->rows() * 3 * this->first(b) + row * 3 * this->size(b);
  return sizeof(Scalar) * static_cast<std::size_t>(before);
}

template <typename Scalar>
void ScratchBlocks<Scalar>::put_rows(int b, Eigen::Index row, const Block& values) {
  file_.write(byte_of(b, row), std::as_bytes(numbers_of(values)));
}

template <typename Scalar>
void ScratchBlocks<Scalar>::change(int b, const std::function<void(Block&)>& change) {
  const auto block = read(b);
  change(*block);
  put_rows(b, 0, *block);
}

template <typename Scalar>
std::shared_ptr<typename ScratchBlocks<Scalar>::Block> ScratchBlocks<Scalar>::read(int b) const {
  auto block = pool_.block(this->rows(), 3 * this->size(b));
  file_.read(byte_of(b, 0), std::as_writable_bytes(numbers_of(*block)));
  return block;
}

template class ScratchBlocks<double>;
template class ScratchBlocks<float>;

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

SequenceBlocks::SequenceBlocks(const SequencePart& sequence, const VertexPart& part, double scale)
    : BlockSource(sequence.frames.frames(), part), sequence_(sequence), scale_(scale) {}

std::shared_ptr<const SequenceBlocks::Block> SequenceBlocks::block(int b) const {
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

}  // namespace mimetra
