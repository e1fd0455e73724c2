#include "toolkit/mesh/frame_store.h"

#include <span>

namespace mimetra {
namespace {

std::size_t byte_of(int frame, Eigen::Index columns) {
  return sizeof(double) * static_cast<std::size_t>(frame * columns);
}

template <typename Poses>
auto numbers_of(Poses&& poses) {
  return std::span(poses.data(), static_cast<std::size_t>(poses.size()));
}

}  // namespace

FrameStore::FrameStore(SequenceHeader header, std::size_t memory_bytes)
    : FrameSource(std::move(header)) {
  const Eigen::Index columns = 3 * Eigen::Index{vertices()};
  if (byte_of(frames(), columns) <= memory_bytes) {
    memory_ = std::make_shared<Frames>(frames(), columns);
  } else {
    file_.emplace();
  }
}

void FrameStore::write(int first, const Frames& poses) {
  check_run(first, poses.rows());
  if (memory_) {
    memory_->middleRows(first, poses.rows()) = poses;
  } else {
    file_->write(byte_of(first, poses.cols()), std::as_bytes(numbers_of(poses)));
  }
}

void FrameStore::read_frames(int first, FramesView poses) const {
  if (memory_) {
    poses = memory_->middleRows(first, poses.rows());
  } else {
    file_->read(byte_of(first, poses.cols()), std::as_writable_bytes(numbers_of(poses)));
  }
}

void FrameStore::read_some_vertices(int first, VertexIndex vertex, FramesView poses) const {
  if (memory_) {
    poses = memory_->block(first, 3 * Eigen::Index{vertex}, poses.rows(), poses.cols());
    return;
  }
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    const auto frame = first + static_cast<int>(row);
    file_->read(byte_of(frame, 3 * Eigen::Index{vertices()}) + byte_of(vertex, 3),
                std::as_writable_bytes(numbers_of(poses.row(row))));
  }
}

std::shared_ptr<const FrameSource> stored(std::shared_ptr<const FrameSource> source,
                                          const Context& context) {
  if (source->is_quick()) return source;
  auto store = std::make_shared<FrameStore>(source->header());
  for_each_block(
      *source, [&](int first, const Frames& poses) { store->write(first, poses); }, context);
  store->commit();
  return store;
}

}  // namespace mimetra
