#include <cmath>

#include "toolkit/io/bytes.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/point_cache.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// First bytes of the header. Version, number of vertices, first frame, frames per sample and
/// number of samples follow.
constexpr std::string_view kPc2Magic{"POINTCACHE2\0", 12};
constexpr std::int32_t kPc2Version = 1;
constexpr std::size_t kPc2Header = kPc2Magic.size() + 5 * 4;

class Pc2File : public StoredPointCache {
 public:
  explicit Pc2File(const fs::path& path) : StoredPointCache(path) {
    std::string head(kPc2Header, '\0');
    if (file_->size() < head.size()) throw IoError(path.string(), "is truncated in its header");
    file_->read(0, head.data(), head.size());
    if (!head.starts_with(kPc2Magic)) throw IoError(path.string(), "is no PC2 point cache");
    const auto version = integer(head, 0);
    if (version != kPc2Version) {
      throw IoError(path.string(), "has PC2 version " + std::to_string(version) + ", expected " +
                                       std::to_string(kPc2Version));
    }
    vertices_ = integer(head, 1);
    start_ = number_at<float>(head.data() + kPc2Magic.size() + 8, std::endian::little);
    step_ = number_at<float>(head.data() + kPc2Magic.size() + 12, std::endian::little);
    frames_ = integer(head, 4);
    positions_ = {kPc2Header, sizeof(float), std::endian::little};
    check_size();
    if (!std::isfinite(start_)) throw IoError(path.string(), "starts at no finite frame");
    if (std::isfinite(step_) && step_ > 0) return;
    throw IoError(path.string(), "has " + std::to_string(step_) +
                                     " frames from one sample to the next, expected more than 0");
  }

 private:
  static std::int32_t integer(const std::string& head, std::size_t field) {
    return number_at<std::int32_t>(head.data() + kPc2Magic.size() + 4 * field, std::endian::little);
  }
};

OpenSequence open_pc2(const fs::path& path, const ReadOptions& options, const Context& context) {
  return open_point_cache(std::make_unique<const Pc2File>(path), options, {}, context);
}

/// Mean number of frames per second.
double rate_of(const Eigen::VectorXd& times) {
  const auto last = times.size() - 1;
  if (last < 1) return kDefaultFramesPerSecond;
  return static_cast<double>(last) / (times[last] - times[0]);
}

PointCacheTarget begin_pc2_file(const SequenceHeader& header, const fs::path& path) {
  std::string head(kPc2Magic);
  append_little_endian(head, kPc2Version);
  append_little_endian(head, static_cast<std::int32_t>(header.connectivity->vertices));
  // Start and step count frames of a scene at the sequence's own rate, as in Blender's exporter.
  append_little_endian(head, static_cast<float>(rate_of(header.times) * header.times[0]));
  append_little_endian(head, 1.0F);
  append_little_endian(head, static_cast<std::int32_t>(header.times.size()));
  PointCacheTarget target{
      std::make_unique<OutputFile>(path), {head.size(), sizeof(float), std::endian::little}, true};
  target.file->write({head});
  return target;
}

std::unique_ptr<FrameSink> begin_pc2(const SequenceHeader& header, const fs::path& target,
                                     const WriteOptions& options, const Context&) {
  return write_point_cache(header, target, options,
                           [&](const fs::path& path) { return begin_pc2_file(header, path); });
}

}  // namespace

Format pc2_format() {
  return {.name = "PC2 point cache",
          .extensions = {".pc2"},
          .reading = reading_parameters(),
          .holds =
              [](const WriteOptions&) {
                HeldParts held = held_in_folder(".ply");
                held.uneven_times = false;  // a single step for all frames
                return held;
              },
          .open = open_pc2,
          .create = begin_pc2};
}

}  // namespace mimetra
