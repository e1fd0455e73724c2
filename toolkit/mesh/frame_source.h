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

/// Poses of one mesh in correspondence, F x 3N: row f is x0 y0 z0 x1 y1 z1 ... of frame f.
using Frames = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of Frames, in place.
using FramesView = Eigen::Map<Frames>;

/// Frames per second of sequences that carry no times.
constexpr double kDefaultFramesPerSecond = 30;

/// Times of `frames` frames at kDefaultFramesPerSecond, from 0 on (F).
Eigen::VectorXd default_times(int frames);

/// A sequence without its poses.
struct SequenceHeader {
  std::shared_ptr<const Connectivity> connectivity = std::make_shared<Connectivity>();
  /// Seconds (F).
  Eigen::VectorXd times = {};
  /// N x 3; the first frame where nobody knows it.
  Positions rest = {};
  bool rest_is_known = false;
  /// False where nobody gave them, so that they follow from kDefaultFramesPerSecond.
  bool times_are_known = false;
};

/// One mesh that moves, whose poses are read when they are needed: one connectivity, F poses, their
/// times, and the rest pose, which need not be a frame.
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
  /// times(), or none where nobody knows them: what the constructors of sequences take.
  Eigen::VectorXd known_times() const {
    return times_are_known() ? header_.times : Eigen::VectorXd();
  }
  /// N x 3; where nobody knows it, it is the first frame.
  const Positions& rest() const { return header_.rest; }
  bool rest_is_known() const { return header_.rest_is_known; }
  /// Largest distance between two vertices of the rest pose that faces use, of all without faces.
  double diameter() const { return mimetra::diameter(rest(), triangles()); }

  /// All poses (F x 3N) where they are in memory; null elsewhere.
  virtual std::shared_ptr<const Frames> in_memory() const { return nullptr; }
  /// True where reading frames again costs hardly more than copying them: they are in memory, are
  /// stored as numbers, or follow from a product. Who reads others many times keeps them: stored().
  virtual bool is_quick() const { return false; }
  /// True where reading some vertices costs what their share of the frames costs.
  virtual bool reads_vertices() const { return false; }

  /// The frames `first` .. first + poses.rows() - 1 (rows x 3N); any run of frames gives the same
  /// numbers. May be called from several threads. Throws std::out_of_range for frames that are not
  /// there, std::invalid_argument unless the rows have 3N columns, and what reading throws.
  void read(int first, FramesView poses) const;
  Frames read(int first, int count) const;
  /// Of the same frames the vertices `vertex` .. vertex + n - 1 (rows x 3n): the same numbers.
  /// Throws as read(), std::out_of_range for vertices that are not there.
  void read_vertices(int first, VertexIndex vertex, FramesView poses) const;
  /// Throws std::out_of_range unless the frames `first` .. first + count - 1 are there.
  void check_run(int first, Eigen::Index count) const;
  /// Throws std::out_of_range unless the vertices `first` .. first + count - 1 are there.
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
  /// \pre the frames are there and `poses` has 3N columns
  virtual void read_frames(int first, FramesView poses) const = 0;
  /// By default frames are read as a whole. \pre the frames and vertices are there
  virtual void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const;
};

/// Takes the poses of a sequence whose header it knows.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// The poses of the frames `first` .. first + poses.rows() - 1, each frame once, in any order.
  /// May be called from several threads. Throws OutputError, MismatchError for what its format
  /// cannot hold.
  virtual void write(int first, const Frames& poses) = 0;
  /// Makes all that was written appear, and returns its files. Without this nothing appears. \pre
  /// every frame was written
  virtual std::vector<std::filesystem::path> commit() = 0;
};

/// Some frames of a source: a view where all are in memory, otherwise they are read.
class FrameBlock {
 public:
  /// Throws as FrameSource::read(). \pre the source outlives it
  FrameBlock(const FrameSource& source, int first, int count);
  FrameBlock(const FrameBlock&) = delete;
  FrameBlock& operator=(const FrameBlock&) = delete;

  int frames() const { return static_cast<int>(poses_.rows()); }
  /// frames() x 3N.
  const Eigen::Map<const Frames>& poses() const { return poses_; }
  /// Pose number `row` of the block (N x 3). \pre 0 <= row < frames()
  PositionsView frame(int row) const;

 private:
  Frames read_;
  Eigen::Map<const Frames> poses_;
};

/// The frames `chosen` of a source, in this order; the rest pose is its own where it is known, else
/// the first chosen one. Throws std::out_of_range for frames that are not there.
std::shared_ptr<const FrameSource> selected(std::shared_ptr<const FrameSource> source,
                                            std::vector<int> chosen);

/// The same frames with another rest pose (N x 3); none where nobody knows it, so that the first
/// frame stands in. Throws std::invalid_argument for another number of vertices.
std::shared_ptr<const FrameSource> with_rest(std::shared_ptr<const FrameSource> source,
                                             std::optional<Positions> rest);

/// The vertices `first` .. first + count - 1 of a source, without faces. Throws std::out_of_range
/// for vertices that are not there.
std::shared_ptr<const FrameSource> some_vertices(std::shared_ptr<const FrameSource> source,
                                                 VertexIndex first, int count);

/// Most bytes of a block of frames, unless one frame takes more.
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;

/// Calls `work` with runs of frames (first frame, how many), each of at most kBlockBytes, that hold
/// every frame once, in any order, from several threads. Throws what `work` throws, Cancelled.
void for_each_run(const FrameSource& source, const std::function<void(int first, int count)>& work,
                  const Context& = {});

/// Calls `work` with every frame of `source` once, in blocks (first frame, poses) of at most
/// kBlockBytes for each thread. Several threads call `work`, in any order. Processes share the
/// reading as Context::for_each_block() does. Throws what reading and `work` throw, Cancelled.
void for_each_block(const FrameSource& source,
                    const std::function<void(int first, const Frames& poses)>& work,
                    const Context& = {});

/// What frames give.
struct FrameNumbers {
  Eigen::VectorXd sum;  ///< over all of them
  FrameRows of_each;    ///< F x what is kept of each
};

/// Computes summed + kept numbers of each frame, adds the first `summed` in the order of the frames
/// and keeps the others. Several threads call `work`, which writes the numbers of a block that
/// starts with frame `first` (frames x (summed + kept), 0 before); processes share the frames. At
/// most kBlockBytes of summands a process are held, or those of eight frames. Throws what reading
/// and `work` throw, Cancelled.
FrameNumbers over_frames(
    const FrameSource& source, Eigen::Index summed, Eigen::Index kept,
    const std::function<void(int first, const FrameBlock& block, FrameRows& numbers)>& work,
    const Context& = {});

/// Mean of all frames (N x 3).
Positions mean_pose(const FrameSource& source);

/// Root mean square over vertices and frames of the distance from the rest pose.
double motion(const FrameSource& source, const Context& = {});

}  // namespace mimetra
