#include <algorithm>
#include <limits>

#include "toolkit/io/mesh_file.h"
#include "toolkit/io/npy_cache.h"
#include "toolkit/io/npy_header.h"
#include "toolkit/io/npy_values.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Frames, and coordinates of one, are counted by ints.
int counted(const fs::path& path, std::size_t size) {
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 3;
  if (size <= kMost) return static_cast<int>(size);
  throw IoError(path.string(), "has " + std::to_string(size) + " frames or vertices, expected " +
                                   std::to_string(kMost) + " at most");
}

/// Three coordinates are one vertex, and more a frame.
bool is_one_frame(const NpyHeader& header) {
  return header.shape.size() == 2 && header.shape[1] == 3;
}

int frames_of(const fs::path& path, const NpyHeader& header) {
  return is_one_frame(header) ? 1 : counted(path, header.shape[0]);
}

int vertices_of(const fs::path& path, const NpyHeader& header) {
  if (is_one_frame(header)) return counted(path, header.shape[0]);
  return counted(path, header.shape.size() == 3 ? header.shape[1] : header.shape[1] / 3);
}

class StoredArray : public StoredPointCache {
 public:
  StoredArray(const fs::path& path, const NpyHeader& header, std::unique_ptr<const InputBytes> file)
      : StoredPointCache(path, std::move(file)) {
    frames_ = frames_of(path, header);
    vertices_ = vertices_of(path, header);
    positions_ = {header.data, header.item_bytes, header.order};
  }
};

/// One that cannot be read in parts.
class LoadedArray : public PointCache {
 public:
  LoadedArray(const fs::path& path, std::string_view bytes) : PointCache(path) {
    const NpyHeader header = read_npy_header(path.string(), bytes);
    check_frames_header(path.string(), header);
    array_ = npy_values(path.string(), bytes, header);
    frames_ = frames_of(path, header);
    vertices_ = vertices_of(path, header);
  }

 private:
  void read_values(int first, FramesView poses) const override {
    std::copy_n(array_.values.begin() + first * poses.cols(), poses.size(), poses.data());
  }

  NumericArray array_;
};

OpenSequence open_npy(const fs::path& path, const SequenceSource& source, const Context& context) {
  return open_point_cache(open_npy_cache(path), source, {}, context);
}

std::unique_ptr<FrameSink> begin_npy(const SequenceHeader& header, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra,
                                     const Context&) {
  const auto begin = [&](const fs::path& path) {
    return begin_npy_cache(path, static_cast<std::size_t>(header.times.size()),
                           static_cast<std::size_t>(header.connectivity->vertices),
                           options.single_precision);
  };
  return write_point_cache(header, target, options, extra, begin);
}

}  // namespace

std::unique_ptr<const PointCache> open_npy_cache(const fs::path& path) {
  if (!InputFile::has_size(path)) {
    return std::make_unique<const LoadedArray>(path, read_file(path));
  }
  return open_npy_cache(path.string(), std::make_unique<const InputFile>(path));
}

std::unique_ptr<const PointCache> open_npy_cache(const std::string& name,
                                                 std::unique_ptr<const InputBytes> bytes) {
  const NpyHeader header = read_npy_header(name, *bytes);
  check_frames_header(name, header);
  if (!header.fortran_order) {
    return std::make_unique<const StoredArray>(name, header, std::move(bytes));
  }
  std::string all(bytes->size(), '\0');
  bytes->read(0, all.data(), all.size());
  return std::make_unique<const LoadedArray>(name, all);
}

PointCacheTarget begin_npy_cache(const fs::path& path, std::size_t frames, std::size_t vertices,
                                 bool single_precision) {
  PointCacheTarget target{std::make_unique<OutputFile>(path), {}};
  target.positions.bytes = single_precision ? sizeof(float) : sizeof(double);
  const std::string header =
      npy_header_bytes(single_precision ? "<f4" : "<f8", {frames, vertices, 3});
  target.positions.offset = header.size();
  target.file->write({header});
  return target;
}

SequenceFormat npy_format() {
  return {"NumPy array",
          {".npy"},
          true,
          SequenceFormat::Precision::double_or_single,
          open_npy,
          begin_npy,
          parts_held_by(MeshFormat::ply)};
}

}  // namespace mimetra
