#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Poses of one mesh, F x 3N: row f is x0 y0 z0 x1 y1 z1 ... of frame f.
using Frames = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// View of rows of Frames.
using FramesView = Eigen::Map<Frames>;

/// Frames per second of sequences without times.
constexpr double kDefaultFramesPerSecond = 30;

/// Times of `frames` frames at kDefaultFramesPerSecond, starting at 0 (F).
Eigen::VectorXd default_times(int frames);

/// Everything in a sequence but its poses.
struct SequenceHeader {
  std::shared_ptr<const Connectivity> connectivity = std::make_shared<Connectivity>();
  /// Seconds (F).
  Eigen::VectorXd times = {};
  /// Rest pose, N x 3; the first frame if rest_is_known is false.
  Positions rest = {};
  bool rest_is_known = false;
  /// False if the times follow from kDefaultFramesPerSecond.
  bool times_are_known = false;
};

/// A moving mesh whose poses are read on demand: one connectivity, F poses, their times, and a rest
/// pose, which need not be a frame.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  const SequenceHeader& header() const { return header_; }
  int frames() const { return static_cast<int>(header_.times.size()); }
  int vertices() const { return header_.connectivity->vertices; }
  const Connectivity& connectivity() const { return *header_.connectivity; }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const {
    return header_.connectivity;
  }
  const Triangles& triangles() const { return header_.connectivity->triangles; }
  /// Seconds (F).
  const Eigen::VectorXd& times() const { return header_.times; }
  bool times_are_known() const { return header_.times_are_known; }
  /// times() if they are known, otherwise empty, as the constructors of sequences expect.
  Eigen::VectorXd known_times() const {
    return times_are_known() ? header_.times : Eigen::VectorXd();
  }
  /// Rest pose, N x 3; the first frame unless rest_is_known().
  const Positions& rest() const { return header_.rest; }
  bool rest_is_known() const { return header_.rest_is_known; }
  /// Largest distance between two vertices of the surface_vertices() of the rest pose.
  double diameter() const { return mimetra::diameter(rest(), triangles()); }

  /// All poses (F x 3N) if they are in memory, otherwise null.
  virtual std::shared_ptr<const Frames> in_memory() const { return nullptr; }
  /// Whether reading frames costs hardly more than copying them: they are in memory, stored as
  /// numbers, or given by a product. Pass other sources through stored() to read them repeatedly.
  virtual bool is_quick() const { return false; }
  /// Whether reading some vertices costs only their share of reading whole frames.
  virtual bool reads_vertices() const { return false; }

  /// Reads frames `first` .. first + poses.rows() - 1 (rows x 3N). The numbers do not depend on how
  /// frames are grouped into calls. Several threads may call it. Throws std::out_of_range for
  /// missing frames, std::invalid_argument unless there are 3N columns, and whatever reading
  /// throws.
  void read(int first, FramesView poses) const;
  Frames read(int first, int count) const;
  /// Reads vertices `vertex` .. vertex + n - 1 of these frames (rows x 3n), with the same numbers
  /// as read(). Throws as read(), and std::out_of_range for missing vertices.
  void read_vertices(int first, VertexIndex vertex, FramesView poses) const;
  /// Throws std::out_of_range unless frames `first` .. first + count - 1 exist.
  void check_run(int first, Eigen::Index count) const;
  /// Throws std::out_of_range unless vertices `first` .. first + count - 1 exist.
  void check_vertices(VertexIndex first, Eigen::Index count) const;

 protected:
  FrameSource() = default;
  explicit FrameSource(SequenceHeader header) : header_(std::move(header)) {}
  FrameSource(const FrameSource&) = default;
  FrameSource(FrameSource&&) = default;
  FrameSource& operator=(const FrameSource&) = default;
  FrameSource& operator=(FrameSource&&) = default;

  SequenceHeader header_;

 private:
  /// \pre the frames exist and `poses` has 3N columns
  virtual void read_frames(int first, FramesView poses) const = 0;
  /// Reads whole frames by default. \pre the frames and vertices exist
  virtual void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const;
};

/// Receives the poses of a sequence whose header it knows.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// Writes frames `first` .. first + poses.rows() - 1. Each frame is written once, in any order;
  /// several threads may call it. Throws OutputError, and MismatchError for values that the format
  /// cannot store.
  virtual void write(int first, const Frames& poses) = 0;
  /// Publishes everything that was written, and returns the files. Without this call no file
  /// appears. \pre every frame was written
  virtual std::vector<std::filesystem::path> commit() = 0;
};

/// Consecutive frames of a source: a view if all frames are in memory, otherwise a copy.
class FrameBlock {
 public:
  /// Throws as FrameSource::read(). \pre the source outlives the block
  FrameBlock(const FrameSource& source, int first, int count);
  FrameBlock(const FrameBlock&) = delete;
  FrameBlock& operator=(const FrameBlock&) = delete;

  int frames() const { return static_cast<int>(poses_.rows()); }
  /// Poses of the block, frames() x 3N.
  const Eigen::Map<const Frames>& poses() const { return poses_; }
  /// Pose number `row` of the block (N x 3). \pre 0 <= row < frames()
  PositionsView frame(int row) const;

 private:
  Frames read_;
  Eigen::Map<const Frames> poses_;
};

/// Frames `chosen` of a source, in this order. The rest pose is the source's if it is known, else
/// the first chosen frame. Throws std::out_of_range for missing frames.
std::shared_ptr<const FrameSource> selected(std::shared_ptr<const FrameSource> source,
                                            std::vector<int> chosen);

/// The same frames with another rest pose (N x 3). Without a value, the rest pose becomes unknown
/// and the first frame replaces it. Throws std::invalid_argument if the number of vertices differs.
std::shared_ptr<const FrameSource> with_rest(std::shared_ptr<const FrameSource> source,
                                             std::optional<Positions> rest);

/// Vertices `first` .. first + count - 1 of a source, without faces. Throws std::out_of_range for
/// missing vertices.
std::shared_ptr<const FrameSource> some_vertices(std::shared_ptr<const FrameSource> source,
                                                 VertexIndex first, int count);

/// Largest size of a block of frames in bytes, unless a single frame takes more.
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

/// Calls `work` with runs of frames (first frame, number of frames) of at most kBlockBytes that
/// cover every frame once. Several threads call `work`, in any order. Throws whatever `work`
/// throws, and Cancelled.
void for_each_run(const FrameSource& source, const std::function<void(int first, int count)>& work,
                  const Context& = {});

/// Calls `work` with every frame of `source` once, in blocks (first frame, poses) of at most
/// kBlockBytes per thread. Several threads call `work`, in any order. Processes share the reading
/// as in Context::for_each_block(). Throws whatever reading and `work` throw, and Cancelled.
void for_each_block(const FrameSource& source,
                    const std::function<void(int first, const Frames& poses)>& work,
                    const Context& = {});

/// Result of over_frames().
struct FrameNumbers {
  Eigen::VectorXd sum;  ///< sum over all frames
  FrameRows of_each;    ///< numbers kept for each frame, F x kept
};

/// Computes summed + kept numbers of each frame. Adds the first `summed` numbers in the order of
/// the frames, and keeps the others.
///
/// Several threads call `work`, which fills the numbers of a block that starts with frame `first`:
/// frames x (summed + kept), 0 before. Processes share the frames. Each process holds summands of
/// kBlockBytes, but of eight frames at least, times the number of processes. Throws whatever
/// reading and `work` throw, and Cancelled.
FrameNumbers over_frames(
    const FrameSource& source, Eigen::Index summed, Eigen::Index kept,
    const std::function<void(int first, const FrameBlock& block, FrameRows& numbers)>& work,
    const Context& = {});

/// Mean of all frames (N x 3).
Positions mean_pose(const FrameSource& source);

/// Root mean square over vertices and frames of the distance from the rest pose.
double motion(const FrameSource& source, const Context& = {});

}  // namespace mimetra
