#include "toolkit/io/array_file.h"

#include <algorithm>
#include <span>

#include "toolkit/io/bytes.h"
#include "toolkit/io/npy_cache.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

template <typename Stored>
void decode_as(const char* stored, const NpyHeader& header, std::span<double> values) {
  const auto decode_in = [stored, values](auto order) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<double>(number_at<Stored>(stored + i * sizeof(Stored), order()));
    }
  };
  // With an order that is known when the loop is compiled, it runs at the speed of memory.
  if (header.order == std::endian::native) {
    decode_in([] { return std::endian::native; });
  } else {
    decode_in([&header] { return header.order; });
  }
}

/// The values in the file's order.
void decode(const char* bytes, const NpyHeader& header, std::span<double> values) {
  const bool is_signed = header.kind == 'i';
  if (header.kind == 'f') {
    header.item_bytes == 4 ? decode_as<float>(bytes, header, values)
                           : decode_as<double>(bytes, header, values);
  } else if (header.item_bytes == 1) {
    is_signed ? decode_as<std::int8_t>(bytes, header, values)
              : decode_as<std::uint8_t>(bytes, header, values);
  } else if (header.item_bytes == 2) {
    is_signed ? decode_as<std::int16_t>(bytes, header, values)
              : decode_as<std::uint16_t>(bytes, header, values);
  } else if (header.item_bytes == 4) {
    is_signed ? decode_as<std::int32_t>(bytes, header, values)
              : decode_as<std::uint32_t>(bytes, header, values);
  } else {
    is_signed ? decode_as<std::int64_t>(bytes, header, values)
              : decode_as<std::uint64_t>(bytes, header, values);
  }
}

/// Fortran order has the first index fastest; here the last one is.
std::vector<double> in_c_order(const std::vector<double>& values,
                               const std::vector<std::size_t>& shape) {
  std::vector<double> ordered(values.size());
  std::vector<std::size_t> index(shape.size(), 0);
  for (const double value : values) {
    std::size_t place = 0;
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
      place = place * shape[axis] + index[axis];
    }
    ordered[place] = value;
    for (std::size_t axis = 0; axis < shape.size() && ++index[axis] == shape[axis]; ++axis) {
      index[axis] = 0;
    }
  }
  return ordered;
}

}  // namespace

NumericArray npy_values(const std::string& path, std::string_view bytes, const NpyHeader& header) {
  NumericArray array{header.shape, std::vector<double>(checked_count(path, bytes.size(), header))};
  decode(bytes.data() + header.data, header, array.values);
  if (header.fortran_order) array.values = in_c_order(array.values, array.shape);
  return array;
}

NumericArray read_npy(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return npy_values(path.string(), bytes, read_npy_header(path.string(), bytes));
}

Frames read_npy_frames(const std::filesystem::path& path, int threads) {
  const auto cache = open_npy_cache(path);
  Frames frames(cache->frames(), 3 * Eigen::Index{cache->vertices()});
  parallel_for(cache->frames(), threads, [&](int frame) {
    cache->read(frame, FramesView(frames.row(frame).data(), 1, frames.cols()));
  });
  return frames;
}

void write_npy_frames(const std::filesystem::path& path, const Frames& frames,
                      bool single_precision, int threads) {
  const auto rows = static_cast<std::size_t>(frames.rows());
  const auto columns = static_cast<std::size_t>(frames.cols());
  const PointCacheTarget array = begin_npy_cache(path, rows, columns / 3, single_precision);
  parallel_for(static_cast<int>(rows), threads, [&](int frame) {
    array.positions.write(*array.file, columns * static_cast<std::size_t>(frame),
                          {frames.row(frame).data(), columns});
  });
  array.file->close();
}

}  // namespace mimetra
