#include "toolkit/io/point_cache.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "toolkit/io/bytes.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// True if all values are coordinates, judged by their bits.
bool all_usable(std::span<const double> values) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  // For values from the limit on, adding this carries into the sign bit.
  constexpr std::uint64_t kRest = kSign - std::bit_cast<std::uint64_t>(kCoordinateLimit);
  std::uint64_t carried = 0;
  for (const double value : values) {
    carried |= (std::bit_cast<std::uint64_t>(value) & ~kSign) + kRest;
  }
  return (carried & kSign) == 0;
}

void check_finite(const fs::path& path, int first, VertexIndex vertex, const FramesView& poses) {
  const std::span<const double> values(poses.data(), static_cast<std::size_t>(poses.size()));
  if (all_usable(values)) return;
  const auto bad = std::ranges::find_if_not(values, is_coordinate);
  const Eigen::Index at = bad - values.begin();
  throw IoError(path.string(), "frame " + std::to_string(first + at / poses.cols()) + ": vertex " +
                                   std::to_string(vertex + at % poses.cols() / 3) +
                                   " has no usable position: " + readable(*bad));
}

template <typename Stored>
std::string encoded(std::span<const double> values, std::endian order) {
  std::string bytes(values.size() * sizeof(Stored), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    put_number_at(bytes.data() + i * sizeof(Stored), static_cast<Stored>(values[i]), order);
  }
  return bytes;
}

/// Frames of a cache on a mesh.
class CachedFrames : public FrameSource {
 public:
  CachedFrames(std::unique_ptr<const PointCache> cache, SequenceHeader header)
      : FrameSource(std::move(header)), cache_(std::move(cache)) {}

  bool is_quick() const override { return true; }
  bool reads_vertices() const override { return cache_->reads_vertices(); }

 private:
  void read_frames(int first, FramesView poses) const override { cache_->read(first, poses); }
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override {
    cache_->read_vertices(first, vertex, poses);
  }

  std::unique_ptr<const PointCache> cache_;
};

Positions pose_of(const PointCache& cache, int frame) {
  Positions pose(cache.vertices(), 3);
  cache.read(frame, FramesView(pose.data(), 1, pose.size()));
  return pose;
}

/// First frame that is read from a cache.
struct FirstPose {
  int frame = 0;
  Positions positions;
};

/// Note on a frame that is unlikely to be a pose of the mesh whose faces it takes; "" if it fits.
std::string note_on_numbering(const fs::path& path, const FirstPose& first,
                              const fs::path& topology, const TriMesh& mesh) {
  constexpr double kMostOfAPose = 0.2;
  const double share =
      share_of_other_edges(first.positions, mesh.positions, mesh.connectivity.triangles);
  if (share <= kMostOfAPose) return {};
  return path.string() + ": in frame " + std::to_string(first.frame) + ' ' + percent(share) +
         " of the edges are more than twice as long or as short as in " + topology.string() +
         ", as where its vertices are in another order, or x, y and z are not beside each other; "
         "take faces from the program that wrote the positions";
}

/// Reads faces, and the rest pose if it is not known, from files beside a cache. Adds a note if
/// they do not seem to fit the first pose.
void add_parts_beside(const PointCache& cache, const FirstPose& first, const ReadOptions& options,
                      PointCacheParts& parts, OpenSequence& open, const Context& context) {
  std::vector<fs::path>& files = open.files;
  const fs::path path = files.front();
  files.push_back(topology_of(name_with(path, kTopologySuffix), options));
  const MeshFileReader reader(files.back(), context);
  if (cache.vertices() != reader.mesh().connectivity.vertices) {
    throw MismatchError(path.string() + ": " + std::to_string(cache.vertices()) +
                        " vertices, expected " + std::to_string(reader.mesh().positions.rows()) +
                        " as in " + files.back().string());
  }
  parts.faces = std::make_shared<const Connectivity>(reader.mesh().connectivity);
  const std::string odd = note_on_numbering(path, first, files.back(), reader.mesh());
  if (!odd.empty()) open.notes.push_back(odd);
  if (!parts.rest) parts.rest = rest_beside(name_with(path, kRestSuffix), reader, files);
}

/// Times of all frames of the cache. Selected frames keep their time in the whole sequence.
FrameTimes times_of(const PointCache& cache, const ReadOptions& options,
                    std::optional<Eigen::VectorXd> known, std::vector<fs::path>& files) {
  if (!known && cache.times().size() > 0) known = cache.times();
  if (!known) {
    known = times_beside(name_with(files.front(), kTimesSuffix), cache.frames(), files);
  }
  const bool by_rate = !known;
  FrameTimes times =
      frame_times(files.front().string(), cache.frames(), std::move(known), options.fps);
  if (by_rate) {
    const double frame = 1 / options.fps.value_or(kDefaultFramesPerSecond);
    times.seconds = cache.start() * frame + cache.step() * times.seconds.array();
  }
  return times;
}

class PointCacheSink : public FrameSink {
 public:
  PointCacheSink(const SequenceHeader& header, const fs::path& target, const WriteOptions& options,
                 const std::function<PointCacheTarget(const fs::path&)>& begin)
      : header_(header),
        target_(target),
        outputs_(options.overwrite, options.inputs, options.together),
        cache_(begin(outputs_.add(target, PendingOutput::Kind::file))),
        columns_(3 * static_cast<std::size_t>(header.connectivity->vertices)) {
    add_extra_beside(outputs_, target_, options.extra, extra_files_);
  }

  void write(int first, const Frames& poses) override {
    if (cache_.positions.bytes == sizeof(float)) {
      check_single_range(target_, first, poses);
      check_single_precision(
          target_, PositionsView(poses.data(), poses.size() / 3, 3), extent(header_.rest),
          cache_.only_single_precision ? SinglePrecision::only : SinglePrecision::asked);
    }
    cache_.positions.write(*cache_.file, columns_ * static_cast<std::size_t>(first),
                           {poses.data(), static_cast<std::size_t>(poses.size())});
  }

  std::vector<fs::path> commit() override {
    cache_.file->close();
    std::vector<fs::path> files = {target_};
    add_topology_beside(outputs_, target_, header_, files);
    add_rest_beside(outputs_, target_, header_, files);
    if (!cache_.holds_times) add_times_beside(outputs_, target_, header_, files);
    files.insert(files.end(), extra_files_.begin(), extra_files_.end());
    outputs_.commit();
    return files;
  }

 private:
  SequenceHeader header_;
  fs::path target_;
  std::vector<fs::path> extra_files_;
  PendingOutputs outputs_;
  PointCacheTarget cache_;
  std::size_t columns_;
};

}  // namespace

void PointCache::read(int first, FramesView poses) const {
  read_values(first, poses);
  check_finite(path_, first, 0, poses);
}

void PointCache::read_vertices(int first, VertexIndex vertex, FramesView poses) const {
  read_some_values(first, vertex, poses);
  check_finite(path_, first, vertex, poses);
}

void PointCache::read_some_values(int first, VertexIndex vertex, FramesView poses) const {
  Frames frame(1, 3 * Eigen::Index{vertices_});
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    read_values(first + static_cast<int>(row), FramesView(frame.data(), 1, frame.cols()));
    poses.row(row) = frame.row(0).segment(3 * Eigen::Index{vertex}, poses.cols());
  }
}

void StoredFloats::read(const InputBytes& file, std::size_t first, std::span<double> values) const {
  const std::size_t from = offset + first * bytes;
  if (bytes == sizeof(double) && order == std::endian::native) {
    file.read(from, reinterpret_cast<char*>(values.data()), values.size_bytes());
    return;
  }
  std::string stored(values.size() * bytes, '\0');
  file.read(from, stored.data(), stored.size());
  if (bytes == sizeof(float)) {
    decode_numbers<float>(stored.data(), order, values);
  } else {
    decode_numbers<double>(stored.data(), order, values);
  }
}

void StoredFloats::write(const OutputFile& file, std::size_t first,
                         std::span<const double> values) const {
  const std::size_t to = offset + first * bytes;
  if (bytes == sizeof(double) && order == std::endian::native) {
    file.write_at(to, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  } else if (bytes == sizeof(float)) {
    file.write_at(to, encoded<float>(values, order));
  } else {
    file.write_at(to, encoded<double>(values, order));
  }
}

void StoredPointCache::check_size() const {
  // The number of frames, and of coordinates in one, must fit int.
  constexpr int kMost = std::numeric_limits<int>::max() / 3;
  if (frames_ < 1 || vertices_ < 1 || frames_ > kMost || vertices_ > kMost) {
    throw IoError(path_.string(), "has " + std::to_string(frames_) + " frames of " +
                                      std::to_string(vertices_) + " vertices, expected 1 to " +
                                      std::to_string(kMost));
  }
  const std::size_t frame = 3 * positions_.bytes * static_cast<std::size_t>(vertices_);
  const auto frames = static_cast<std::size_t>(frames_);
  const std::size_t held = file_->size() - std::min(file_->size(), positions_.offset);
  const std::string wanted =
      std::to_string(frames_) + " frames of " + std::to_string(vertices_) + " vertices";
  if (held / frame < frames) {
    throw IoError(path_.string(),
                  "is truncated: " + std::to_string(file_->size()) + " bytes, expected " + wanted);
  }
  if (held == frame * frames) return;
  throw IoError(path_.string(),
                std::to_string(held - frame * frames) + " bytes follow its " + wanted);
}

void StoredPointCache::read_values(int first, FramesView poses) const {
  const std::size_t columns = 3 * static_cast<std::size_t>(vertices_);
  positions_.read(*file_, columns * static_cast<std::size_t>(first),
                  {poses.data(), static_cast<std::size_t>(poses.size())});
}

void StoredPointCache::read_some_values(int first, VertexIndex vertex, FramesView poses) const {
  const std::size_t columns = 3 * static_cast<std::size_t>(vertices_);
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    const auto frame = static_cast<std::size_t>(first + row);
    positions_.read(*file_, columns * frame + 3 * static_cast<std::size_t>(vertex),
                    {poses.row(row).data(), static_cast<std::size_t>(poses.cols())});
  }
}

OpenSequence open_point_cache(std::unique_ptr<const PointCache> cache, const ReadOptions& options,
                              PointCacheParts parts, const Context& context) {
  OpenSequence open;
  open.files = {parts.path.empty() ? cache->path() : parts.path};
  const std::vector<int> chosen = selected_frames(options.frames, cache->frames());
  // Frames outside the selection are not read.
  FirstPose first{chosen.front(), {}};
  if (!parts.faces || !parts.rest) first.positions = pose_of(*cache, first.frame);
  if (!parts.faces) add_parts_beside(*cache, first, options, parts, open, context);
  SequenceHeader header;
  header.connectivity = std::move(parts.faces);
  FrameTimes times = times_of(*cache, options, std::move(parts.times), open.files);
  header.times = std::move(times.seconds);
  header.times_are_known = times.are_known;
  header.rest_is_known = parts.rest.has_value();
  header.rest = parts.rest ? *std::move(parts.rest) : std::move(first.positions);
  open.frames = std::make_shared<const CachedFrames>(std::move(cache), std::move(header));
  if (options.frames) open.frames = selected(open.frames, chosen);
  return open;
}

std::unique_ptr<FrameSink> write_point_cache(
    const SequenceHeader& header, const fs::path& target, const WriteOptions& options,
    const std::function<PointCacheTarget(const fs::path&)>& begin) {
  return std::make_unique<PointCacheSink>(header, target, options, begin);
}

}  // namespace mimetra
