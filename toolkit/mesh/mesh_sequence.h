#pragma once

#include <memory>
#include <optional>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// A sequence in memory.
///
/// All poses form one block, which copies share.
class MeshSequence : public FrameSource {
 public:
  MeshSequence() = default;
  /// `frames` is F x 3N with F >= 1. `times` (F) are increasing seconds, or empty if unknown.
  /// `rest` is N x 3, or empty if unknown. Throws std::invalid_argument otherwise.
  MeshSequence(Connectivity connectivity, Frames frames, Eigen::VectorXd times = {},
               std::optional<Positions> rest = {});
  MeshSequence(std::shared_ptr<const Connectivity> connectivity, Frames frames,
               Eigen::VectorXd times = {}, std::optional<Positions> rest = {});
  /// Copies all frames of `source`, or shares them if they are in memory. Throws whatever reading
  /// throws, and Cancelled.
  explicit MeshSequence(const FrameSource& source, const Context& = {});

  /// Positions of frame f (N x 3), a view into this sequence. \pre 0 <= f < frames()
  PositionsView frame(int f) const;
  /// All frames, F x 3N.
  const Frames& positions() const { return *frames_; }
  std::shared_ptr<const Frames> in_memory() const override { return frames_; }
  bool is_quick() const override { return true; }
  bool reads_vertices() const override { return true; }

  /// Frames first, first + step, ... below `last`. Throws std::invalid_argument unless
  /// 0 <= first < last <= frames() and step >= 1.
  MeshSequence slice(int first, int last, int step = 1) const;
  /// The same frames with another rest pose. Throws std::invalid_argument unless it is N x 3.
  MeshSequence with_rest(Positions rest) const;
  /// The same connectivity, times and rest pose with other poses, F x 3N. Throws
  /// std::invalid_argument if their shape differs.
  MeshSequence with_frames(Frames frames) const;

 private:
  MeshSequence(std::shared_ptr<const Connectivity> connectivity,
               std::shared_ptr<const Frames> frames, Eigen::VectorXd times,
               std::optional<Positions> rest);

  void read_frames(int first, FramesView poses) const override;
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override;

  std::shared_ptr<const Frames> frames_ = std::make_shared<Frames>();
};

}  // namespace mimetra
