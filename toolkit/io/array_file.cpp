#include "toolkit/io/array_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <span>

#include "toolkit/io/bytes.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/npy_array.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kVersionAt = 6;

/// Returns the text of the header's dictionary and sets `data` to its end. Versions 2 and 3 have a
/// longer length field.
std::string_view dictionary(const std::string& path, std::string_view bytes, std::size_t& data) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (bytes.substr(0, kMagic.size()) != kMagic) throw IoError(path, "is no NumPy array");
  const std::size_t version =
      bytes.size() > kVersionAt ? static_cast<unsigned char>(bytes[kVersionAt]) : 0;
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  const std::size_t start = 8 + length_bytes;
  if (bytes.size() < start) throw IoError(path, "is truncated in its header");
  if (version < 1 || version > 3) {
    throw IoError(path,
                  "has NumPy format version " + std::to_string(version) + ", expected 1, 2 or 3");
  }
  const std::size_t length = version == 1
                                 ? number_at<std::uint16_t>(bytes.data() + 8, std::endian::little)
                                 : number_at<std::uint32_t>(bytes.data() + 8, std::endian::little);
  if (bytes.size() - start < length) throw IoError(path, "is truncated in its header");
  data = start + length;
  return bytes.substr(start, length);
}

/// Returns the text that follows `'key':` in a Python dictionary.
std::string_view value_of(const std::string& path, std::string_view text, const std::string& key) {
  for (const char quote : {'\'', '"'}) {
    const std::size_t at = text.find(quote + key + quote);
    const std::size_t colon = at == std::string_view::npos ? at : text.find(':', at);
    const std::size_t value =
        colon == std::string_view::npos ? colon : text.find_first_not_of(" \t\n", colon + 1);
    if (value == std::string_view::npos) continue;
    if (text.find(quote + key + quote, at + 1) != std::string_view::npos) {
      throw IoError(path, "its header has '" + key + "' twice");
    }
    return text.substr(value);
  }
  throw IoError(path, "its header has no '" + key + "'");
}

void parse_type(const std::string& path, std::string_view text, NpyHeader& header) {
  const std::string_view type =
      text[0] == '\'' || text[0] == '"' ? text.substr(1, text.find(text[0], 1) - 1) : "";
  const bool sound = type.size() == 3 && std::string_view("<>=|").find(type[0]) < 4 &&
                     std::string_view("fiub").find(type[1]) < 4;
  const std::size_t bytes = sound ? static_cast<std::size_t>(type[2] - '0') : 0;
  const bool known = (bytes == 4 || bytes == 8) || (bytes == 2 && sound && type[1] != 'f') ||
                     (bytes == 1 && sound && type[1] != 'f');
  if (!known || (type[1] == 'b' && bytes != 1)) {
    const bool is_word = !type.empty() && type.size() <= 20;
    throw IoError(path, "has values of type " + std::string(is_word ? type : text.substr(0, 20)) +
                            ", expected float32, float64 or, for indices, integers; write "
                            "array.astype('float32')");
  }
  if (type[0] == '>') header.order = std::endian::big;
  if (type[0] == '=') header.order = std::endian::native;
  header.kind = type[1];
  header.item_bytes = bytes;
}

void parse_shape(const std::string& path, std::string_view text, NpyHeader& header) {
  const std::size_t end = text.find(')');
  if (text[0] != '(' || end == std::string_view::npos) {
    throw IoError(path, "its header has no shape");
  }
  for (std::string_view rest = text.substr(1, end - 1); !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view field = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    const std::size_t first = field.find_first_not_of(' ');
    if (first == std::string_view::npos) continue;
    std::size_t size = 0;
    const auto [last, error] =
        std::from_chars(field.data() + first, field.data() + field.size(), size);
    if (error != std::errc() || field.find_first_not_of(' ', last - field.data()) < field.size()) {
      throw IoError(path, "its shape is " + std::string(text.substr(0, end + 1)));
    }
    header.shape.push_back(size);
  }
}

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "a single number" : text;
}

NpyHeader read_npy_header(const std::string& path, std::string_view bytes) {
  NpyHeader header;
  const std::string_view text = dictionary(path, bytes, header.data);
  parse_type(path, value_of(path, text, "descr"), header);
  const std::string_view order = value_of(path, text, "fortran_order");
  header.fortran_order = order.starts_with("True");
  if (!header.fortran_order && !order.starts_with("False")) {
    throw IoError(path, "its fortran_order is neither True nor False");
  }
  parse_shape(path, value_of(path, text, "shape"), header);
  return header;
}

std::size_t checked_count(const std::string& path, std::size_t file_bytes,
                          const NpyHeader& header) {
  const std::size_t data_bytes = file_bytes - header.data;
  const std::size_t held = data_bytes / header.item_bytes;
  const bool empty = std::find(header.shape.begin(), header.shape.end(), 0u) != header.shape.end();
  std::size_t count = empty ? 0 : 1;
  for (const std::size_t size : header.shape) {
    if (!empty && count > held / size) {
      throw IoError(path, "is truncated: " + std::to_string(held) + " values, expected " +
                              shape_text(header.shape));
    }
    count *= size;
  }
  if (data_bytes != count * header.item_bytes) {
    throw IoError(path, std::to_string(data_bytes - count * header.item_bytes) +
                            " bytes follow the values, expected the end of the file after " +
                            shape_text(header.shape));
  }
  return count;
}

NpyHeader read_npy_header(const std::string& path, const InputBytes& file) {
  constexpr std::size_t kMost = 1 << 17;
  std::string bytes(std::min(file.size(), kMost), '\0');
  file.read(0, bytes.data(), bytes.size());
  const NpyHeader header = read_npy_header(path, bytes);
  checked_count(path, file.size(), header);
  return header;
}

void check_frames_header(const std::string& path, const NpyHeader& header) {
  const std::vector<std::size_t>& shape = header.shape;
  const bool is_sound = (shape.size() == 3 && shape[2] == 3) ||
                        (shape.size() == 2 && shape[1] % 3 == 0 && shape[1] > 0);
  if (!is_sound) {
    throw IoError(path, "has shape " + shape_text(shape) +
                            ", expected frames x vertices x 3 or vertices x 3, or frames x "
                            "coordinates (x y z x y z ...)");
  }
  if (header.kind != 'f') {
    throw IoError(path, "holds integers, expected positions in float32 or float64");
  }
  for (const std::size_t size : header.shape) {
    if (size == 0) throw IoError(path, "is empty: its shape is " + shape_text(header.shape));
  }
}

std::string npy_header_bytes(std::string_view type, const std::vector<std::size_t>& shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += (sizes.empty() ? "" : ", ") + std::to_string(size);
  if (shape.size() == 1) sizes += ',';
  std::string text =
      "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" + sizes + "), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;
  text.append((kAlignment - (kBefore + text.size() + 1) % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes.append({'\1', '\0'});
  append_little_endian(bytes, static_cast<std::uint16_t>(text.size()));
  return bytes + text;
}

namespace {

/// Decodes the values in the file's order.
void decode(const char* bytes, const NpyHeader& header, std::span<double> values) {
  const bool is_signed = header.kind == 'i';
  if (header.kind == 'f') {
    header.item_bytes == 4 ? decode_numbers<float>(bytes, header.order, values)
                           : decode_numbers<double>(bytes, header.order, values);
  } else if (header.item_bytes == 1) {
    is_signed ? decode_numbers<std::int8_t>(bytes, header.order, values)
              : decode_numbers<std::uint8_t>(bytes, header.order, values);
  } else if (header.item_bytes == 2) {
    is_signed ? decode_numbers<std::int16_t>(bytes, header.order, values)
              : decode_numbers<std::uint16_t>(bytes, header.order, values);
  } else if (header.item_bytes == 4) {
    is_signed ? decode_numbers<std::int32_t>(bytes, header.order, values)
              : decode_numbers<std::uint32_t>(bytes, header.order, values);
  } else {
    is_signed ? decode_numbers<std::int64_t>(bytes, header.order, values)
              : decode_numbers<std::uint64_t>(bytes, header.order, values);
  }
}

/// Reorders values from Fortran order (first index fastest) to C order (last index fastest).
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

namespace {

/// Frames and the coordinates of a frame are counted by ints.
int counted(const fs::path& path, std::size_t size) {
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 3;
  if (size <= kMost) return static_cast<int>(size);
  throw IoError(path.string(), "has " + std::to_string(size) + " frames or vertices, expected " +
                                   std::to_string(kMost) + " at most");
}

/// A 2-D array with 3 columns is one frame; with more columns, each row is a frame.
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

/// An array that cannot be read in parts.
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

OpenSequence open_npy(const fs::path& path, const ReadOptions& options, const Context& context) {
  return open_point_cache(open_npy_cache(path), options, {}, context);
}

std::unique_ptr<FrameSink> begin_npy(const SequenceHeader& header, const fs::path& target,
                                     const WriteOptions& options, const Context&) {
  const auto begin = [&](const fs::path& path) {
    return begin_npy_cache(path, static_cast<std::size_t>(header.times.size()),
                           static_cast<std::size_t>(header.connectivity->vertices),
                           options.single_precision);
  };
  return write_point_cache(header, target, options, begin);
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

Format npy_format() {
  return {.name = "NumPy array",
          .extensions = {".npy"},
          .reading = reading_parameters(),
          .writing = writing_parameters({"single"}),
          .holds = [](const WriteOptions&) { return held_in_folder(".ply"); },
          .open = open_npy,
          .create = begin_npy};
}

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
