#include "toolkit/io/array_file.h"

#include "toolkit/io/npy_cache.h"
#include "toolkit/io/npy_header.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {

NumericArray read_npy(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return npy_values(path.string(), bytes, read_npy_header(path.string(), bytes));
}

Frames read_npy_frames(const std::filesystem::path& path, const Context& context) {
  const auto cache = open_npy_cache(path);
  Frames frames(cache->frames(), 3 * Eigen::Index{cache->vertices()});
  parallel_for(
      cache->frames(),
      [&](int frame) {
        cache->read(frame, FramesView(frames.row(frame).data(), 1, frames.cols()));
      },
      context);
  return frames;
}

void write_npy_frames(const std::filesystem::path& path, const Frames& frames,
                      bool single_precision, const Context& context) {
  const auto rows = static_cast<std::size_t>(frames.rows());
  const auto columns = static_cast<std::size_t>(frames.cols());
  const PointCacheTarget array = begin_npy_cache(path, rows, columns / 3, single_precision);
  const auto write = [&](int frame) {
    array.positions.write(*array.file, columns * static_cast<std::size_t>(frame),
                          {frames.row(frame).data(), columns});
  };
  parallel_for(static_cast<int>(rows), write, context);
  array.file->close();
}

}  // namespace mimetra
