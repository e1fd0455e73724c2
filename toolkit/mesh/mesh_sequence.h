#pragma once

#include <memory>
#include <optional>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Poses of one mesh in correspondence, F x 3N: row f is x0 y0 z0 x1 y1 z1 ... of frame f.
using Frames = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Frames per second of sequences that carry no times.
constexpr double kDefaultFramesPerSecond = 30;

/// One mesh that moves: one connectivity, F poses, their times, and the rest pose.
///
/// All poses are one block of memory, which copies share. The rest pose need not be a frame; where
/// nobody knows it, it is the first frame and `rest_is_known()` says false.
class MeshSequence {
 public:
  MeshSequence() = default;
  /// `frames` F x 3N with F >= 1; `times` F, in seconds, or empty for kDefaultFramesPerSecond;
  /// `rest` N x 3 where it is known. Throws std::invalid_argument where sizes disagree.
  MeshSequence(Connectivity connectivity, Frames frames, Eigen::VectorXd times = {},
               std::optional<Positions> rest = {});
  /// Shares a connectivity.
  MeshSequence(std::shared_ptr<const Connectivity> connectivity, Frames frames,
               Eigen::VectorXd times = {}, std::optional<Positions> rest = {});

  int frames() const { return static_cast<int>(frames_->rows()); }
  int vertices() const { return static_cast<int>(frames_->cols() / 3); }
  const Connectivity& connectivity() const { return *connectivity_; }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const { return connectivity_; }
  const Triangles& triangles() const { return connectivity_->triangles; }

  /// Positions of frame f (N x 3), a view into this sequence. \pre 0 <= f < frames()
  PositionsView frame(int f) const;
  /// All frames, F x 3N.
  const Frames& positions() const { return *frames_; }
  /// Seconds (F).
  const Eigen::VectorXd& times() const { return times_; }

  const Positions& rest() const { return rest_; }
  bool rest_is_known() const { return rest_is_known_; }
  /// Longest side of the rest pose's bounding box.
  double extent() const { return mimetra::extent(rest_); }

  /// Frames first, first + step, ... before `last`. Throws std::invalid_argument unless
  /// 0 <= first < last <= frames() and step >= 1.
  MeshSequence slice(int first, int last, int step = 1) const;
  /// The same frames with another rest pose. Throws std::invalid_argument unless it is N x 3.
  MeshSequence with_rest(Positions rest) const;
  /// The same connectivity, times and rest with other poses, F x 3N.
  MeshSequence with_frames(Frames frames) const;

 private:
  MeshSequence(std::shared_ptr<const Connectivity> connectivity,
               std::shared_ptr<const Frames> frames, Eigen::VectorXd times,
               std::optional<Positions> rest);

  std::shared_ptr<const Connectivity> connectivity_ = std::make_shared<Connectivity>();
  std::shared_ptr<const Frames> frames_ = std::make_shared<Frames>();
  Eigen::VectorXd times_;
  Positions rest_;
  bool rest_is_known_ = false;
};

/// Mean of all frames (N x 3).
Positions mean_pose(const MeshSequence& sequence);

/// Root mean square over vertices and frames of the distance from the rest pose.
double motion(const MeshSequence& sequence);

}  // namespace mimetra
