#include <algorithm>

#include "toolkit/io/bytes.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/point_cache.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Size of the header, in bytes: number of frames, number of vertices. The time of each frame
/// follows; all numbers are big-endian.
constexpr std::size_t kMddHeader = 2 * sizeof(std::int32_t);

class MddFile : public StoredPointCache {
 public:
  explicit MddFile(const fs::path& path) : StoredPointCache(path) {
    std::string head(kMddHeader, '\0');
    if (file_->size() < head.size()) throw IoError(path.string(), "is truncated in its header");
    file_->read(0, head.data(), head.size());
    frames_ = number_at<std::int32_t>(head.data(), std::endian::big);
    vertices_ = number_at<std::int32_t>(head.data() + 4, std::endian::big);
    const std::size_t times = sizeof(float) * static_cast<std::size_t>(std::max(frames_, 0));
    positions_ = {kMddHeader + times, sizeof(float), std::endian::big};
    check_size();
    read_times();
  }

 private:
  void read_times() {
    times_.resize(frames_);
    StoredFloats{kMddHeader, sizeof(float), std::endian::big}.read(
        *file_, 0, {times_.data(), static_cast<std::size_t>(frames_)});
    check_times(path_.string(), times_);
  }
};

OpenSequence open_mdd(const fs::path& path, const ReadOptions& options, const Context& context) {
  return open_point_cache(std::make_unique<const MddFile>(path), options, {}, context);
}

/// Times such as seconds since midnight can be too large for single precision.
void check_rounded_times(const fs::path& target, const Eigen::VectorXd& times) {
  for (Eigen::Index frame = 1; frame < times.size(); ++frame) {
    if (static_cast<float>(times[frame]) > static_cast<float>(times[frame - 1])) continue;
    throw MismatchError(target.string() +
                        ": .mdd holds times in single precision, in which frame " +
                        std::to_string(frame) + " at " + readable(times[frame], 12) +
                        " s is not later than the one before; write .npz");
  }
}

PointCacheTarget begin_mdd_file(const SequenceHeader& header, const fs::path& path) {
  std::string head;
  append_bytes_of(head, static_cast<std::int32_t>(header.times.size()), std::endian::big);
  append_bytes_of(head, static_cast<std::int32_t>(header.connectivity->vertices), std::endian::big);
  for (const double time : header.times) {
    append_bytes_of(head, static_cast<float>(time), std::endian::big);
  }
  PointCacheTarget target{std::make_unique<OutputFile>(path),
                          {head.size(), sizeof(float), std::endian::big},
                          true,
                          true};
  target.file->write({head});
  return target;
}

std::unique_ptr<FrameSink> begin_mdd(const SequenceHeader& header, const fs::path& target,
                                     const WriteOptions& options, const Context&) {
  check_rounded_times(target, header.times);
  return write_point_cache(header, target, options,
                           [&](const fs::path& path) { return begin_mdd_file(header, path); });
}

}  // namespace

Format mdd_format() {
  return {.name = "MDD point cache",
          .extensions = {".mdd"},
          .reading = reading_parameters(),
          .holds =
              [](const WriteOptions&) {
                HeldParts held = held_in_folder(".ply");
                held.exact_times = false;
                return held;
              },
          .open = open_mdd,
          .create = begin_mdd};
}

}  // namespace mimetra
