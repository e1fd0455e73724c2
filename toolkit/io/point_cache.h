#pragma once

#include <bit>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"

/// Files with positions over time, without faces. Internal to their formats.
namespace mimetra {

/// Point cache, open for reading.
class PointCache {
 public:
  virtual ~PointCache() = default;

  const std::filesystem::path& path() const { return path_; }
  int frames() const { return frames_; }
  int vertices() const { return vertices_; }
  /// Seconds (F); empty if the file stores none.
  const Eigen::VectorXd& times() const { return times_; }
  /// For files without times: the first frame in the animation, and the number of animation frames
  /// from one cached frame to the next.
  double start() const { return start_; }
  double step() const { return step_; }

  /// Reads frames from `first` on (x 3N). Safe to call from several threads. Throws IoError, also
  /// for a position that is not finite.
  void read(int first, FramesView poses) const;
  /// Reads the vertices from `vertex` on (x 3n), of frames from `first` on.
  void read_vertices(int first, VertexIndex vertex, FramesView poses) const;
  /// True if read_vertices() does not have to read whole frames.
  virtual bool reads_vertices() const { return false; }

 protected:
  explicit PointCache(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
  int frames_ = 0;
  int vertices_ = 0;
  Eigen::VectorXd times_ = {};
  double start_ = 0;
  double step_ = 1;

 private:
  virtual void read_values(int first, FramesView poses) const = 0;
  virtual void read_some_values(int first, VertexIndex vertex, FramesView poses) const;
};

/// Floating-point numbers stored consecutively in a file.
struct StoredFloats {
  std::size_t offset = 0;  ///< offset of the first number, in bytes
  std::size_t bytes = 4;   ///< bytes of each number: 4 or 8
  std::endian order = std::endian::little;

  /// Reads the numbers from `first` on. Throws IoError.
  void read(const InputBytes& file, std::size_t first, std::span<double> values) const;
  /// Writes the numbers from `first` on. Throws OutputError.
  void write(const OutputFile& file, std::size_t first, std::span<const double> values) const;
};

/// Cache that stores frame after frame, x y z of each vertex.
class StoredPointCache : public PointCache {
 public:
  bool reads_vertices() const override { return true; }

 protected:
  StoredPointCache(const std::filesystem::path& path, std::unique_ptr<const InputBytes> file)
      : PointCache(path), file_(std::move(file)) {}
  explicit StoredPointCache(const std::filesystem::path& path)
      : StoredPointCache(path, std::make_unique<const InputFile>(path)) {}

  /// Throws IoError unless the file ends with the last frame and has at least one frame and vertex.
  void check_size() const;

  std::unique_ptr<const InputBytes> file_;
  StoredFloats positions_;

 private:
  void read_values(int first, FramesView poses) const override;
  void read_some_values(int first, VertexIndex vertex, FramesView poses) const override;
};

/// Data that a file stores besides a cache.
struct PointCacheParts {
  std::filesystem::path path = {};  ///< empty for the cache's path
  std::shared_ptr<const Connectivity> faces = {};
  std::optional<Eigen::VectorXd> times = {};
  std::optional<Positions> rest = {};
};

/// Opens the frames that `options` select. If the file has no faces, they come from
/// `options.topology` or from NAME.topology.ply beside it, and the rest pose from NAME.rest.ply.
/// Throws IoError, MismatchError, Cancelled.
OpenSequence open_point_cache(std::unique_ptr<const PointCache> cache, const ReadOptions& options,
                              PointCacheParts parts = {}, const Context& context = {});

/// Destination of a cache's frames.
struct PointCacheTarget {
  /// File at PendingOutput's path, in which everything before the positions is already written.
  std::unique_ptr<OutputFile> file;
  StoredFloats positions;
  /// True if the format has single precision only. Poses that it would round too much are refused.
  bool only_single_precision = false;
  /// True if the file stores times; otherwise they go to NAME.times.csv.
  bool holds_times = false;
};

/// Writes a cache with NAME.topology.ply beside it, and NAME.rest.ply and NAME.times.csv if those
/// are known. `begin` makes the file at a path. Throws OutputError, and MismatchError for poses too
/// far from the origin for the format's precision.
std::unique_ptr<FrameSink> write_point_cache(
    const SequenceHeader& header, const std::filesystem::path& target, const WriteOptions& options,
    const std::function<PointCacheTarget(const std::filesystem::path&)>& begin);

}  // namespace mimetra
