#pragma once

#include <bit>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/context.h"

/// Files with positions over time and without faces. Internal to the formats that are such files.
namespace mimetra {

/// One such file, open for reading.
class PointCache {
 public:
  virtual ~PointCache() = default;

  const std::filesystem::path& path() const { return path_; }
  int frames() const { return frames_; }
  int vertices() const { return vertices_; }
  /// Seconds (F); empty where the file holds none.
  const Eigen::VectorXd& times() const { return times_; }
  /// Where it holds none: the frame of the animation at which it starts, and how many of those lie
  /// from one of its frames to the next.
  double start() const { return start_; }
  double step() const { return step_; }

  /// Frames from `first` on (x 3N). From several threads. Throws IoError, also for a position that
  /// is not finite.
  void read(int first, FramesView poses) const;
  /// The same of the vertices from `vertex` on (x 3n).
  void read_vertices(int first, VertexIndex vertex, FramesView poses) const;
  /// True where these are found without reading whole frames.
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

/// Floating-point numbers that stand one after the other in a file.
struct StoredFloats {
  std::size_t offset = 0;  ///< of the first, in bytes
  std::size_t bytes = 4;   ///< of each: 4 or 8
  std::endian order = std::endian::little;

  /// Those from number `first` on. Throws IoError.
  void read(const InputBytes& file, std::size_t first, std::span<double> values) const;
  /// Throws OutputError.
  void write(const OutputFile& file, std::size_t first, std::span<const double> values) const;
};

/// A cache whose positions stand frame after frame, x y z of each vertex.
class StoredPointCache : public PointCache {
 public:
  bool reads_vertices() const override { return true; }

 protected:
  StoredPointCache(const std::filesystem::path& path, std::unique_ptr<const InputBytes> file)
      : PointCache(path), file_(std::move(file)) {}
  explicit StoredPointCache(const std::filesystem::path& path)
      : StoredPointCache(path, std::make_unique<const InputFile>(path)) {}

  /// Throws IoError unless the file ends with the last frame, and for no frames or vertices.
  void check_size() const;

  std::unique_ptr<const InputBytes> file_;
  StoredFloats positions_;

 private:
  void read_values(int first, FramesView poses) const override;
  void read_some_values(int first, VertexIndex vertex, FramesView poses) const override;
};

/// What a file holds besides a cache.
struct PointCacheParts {
  std::filesystem::path path = {};  ///< empty for the cache's own
  std::shared_ptr<const Connectivity> faces = {};
  std::optional<Eigen::VectorXd> times = {};
  std::optional<Positions> rest = {};
};

/// The frames that `source` takes of a cache. Where its file holds no faces they are those of
/// `source.topology` or NAME.topology.ply beside it, and the rest pose is NAME.rest.ply. Throws
/// IoError, MismatchError, Cancelled.
OpenSequence open_point_cache(std::unique_ptr<const PointCache> cache, const SequenceSource& source,
                              PointCacheParts parts = {}, const Context& context = {});

/// Where a cache's frames go.
struct PointCacheTarget {
  /// Made by PendingOutput: whatever stands before the positions is written by now.
  std::unique_ptr<OutputFile> file;
  StoredFloats positions;
  /// True where the format has no other: poses that it would round too much are refused.
  bool only_single_precision = false;
  /// Otherwise they go to NAME.times.csv.
  bool holds_times = false;
};

/// Writes a cache, with NAME.topology.ply and, where they are known, NAME.rest.ply and
/// NAME.times.csv beside it. `begin`
/// makes the file at a path. Throws OutputError; MismatchError for poses that lie too far from the
/// origin for the format's precision.
std::unique_ptr<FrameSink> write_point_cache(
    const SequenceHeader& header, const std::filesystem::path& target,
    const SequenceWriteOptions& options, const ExtraFiles& extra,
    const std::function<PointCacheTarget(const std::filesystem::path&)>& begin);

}  // namespace mimetra
