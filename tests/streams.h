#pragma once

#include <atomic>
#include <memory>
#include <stdexcept>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra::test {

/// The frames of a sequence as a file of meshes has them: they are read, and reading is slow.
class Stream : public FrameSource {
 public:
  /// Reading the frame `broken` throws std::runtime_error.
  explicit Stream(const MeshSequence& sequence, int broken = -1)
      : FrameSource(sequence.header()), frames_(sequence.positions()), broken_(broken) {}

  /// Frames that were read, each as often as it was.
  int frames_read() const { return frames_read_; }

 private:
  void read_frames(int first, FramesView poses) const override {
    if (first <= broken_ && broken_ < first + poses.rows()) {
      throw std::runtime_error("frame " + std::to_string(broken_) + " is broken");
    }
    poses = frames_.middleRows(first, poses.rows());
    frames_read_ += static_cast<int>(poses.rows());
  }

  Frames frames_;
  int broken_;
  mutable std::atomic<int> frames_read_ = 0;
};

inline std::shared_ptr<const Stream> streamed(const MeshSequence& sequence, int broken = -1) {
  return std::make_shared<const Stream>(sequence, broken);
}

}  // namespace mimetra::test
