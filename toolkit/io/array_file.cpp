#include "toolkit/io/array_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/bytes.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

constexpr std::size_t kVersionAt = 6;

/// What stands before the values.
struct NpyHeader {
  std::endian order = std::endian::little;
  char kind = 'f';  ///< f, i, u or b
  std::size_t item_bytes = 8;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data = 0;  ///< where the values start
};

/// The text of the header's dictionary. Versions 2 and 3 have a longer length field.
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

/// What follows `'key':` in a Python dictionary.
std::string_view value_of(const std::string& path, std::string_view text, const std::string& key) {
  for (const char quote : {'\'', '"'}) {
    const std::size_t at = text.find(quote + key + quote);
    const std::size_t colon = at == std::string_view::npos ? at : text.find(':', at);
    const std::size_t value =
        colon == std::string_view::npos ? colon : text.find_first_not_of(" \t\n", colon + 1);
    if (value != std::string_view::npos) return text.substr(value);
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
    throw IoError(path, "has values of type " + std::string(text.substr(0, 20)) +
                            ", expected float32, float64 or integers");
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

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "a single number" : text;
}

/// Number of values, which the file holds exactly: found before memory is asked for.
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

NpyHeader read_header(const std::string& path, std::string_view bytes) {
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

NumericArray read_array(const std::string& path, std::string_view bytes, const NpyHeader& header) {
  NumericArray array{header.shape, std::vector<double>(checked_count(path, bytes.size(), header))};
  decode(bytes.data() + header.data, header, array.values);
  if (header.fortran_order) array.values = in_c_order(array.values, array.shape);
  return array;
}

void check_frames_header(const std::string& path, const NpyHeader& header) {
  const std::size_t axes = header.shape.size();
  if ((axes != 2 && axes != 3) || header.shape.back() != 3) {
    throw IoError(path, "has shape " + shape_text(header.shape) +
                            ", expected frames x vertices x 3 or vertices x 3");
  }
  if (header.kind != 'f') {
    throw IoError(path, "holds integers, expected positions in float32 or float64");
  }
  for (const std::size_t size : header.shape) {
    if (size == 0) throw IoError(path, "is empty: its shape is " + shape_text(header.shape));
  }
}

Frames frames_of(const NumericArray& array) {
  const auto rows = static_cast<Eigen::Index>(array.shape.size() == 3 ? array.shape[0] : 1);
  return Eigen::Map<const Frames>(array.values.data(), rows,
                                  static_cast<Eigen::Index>(array.values.size()) / rows);
}

/// True where no exponent is that of infinity and of what is not a number.
bool all_finite(std::span<const double> values) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63, kOne = std::uint64_t{1} << 52;
  std::uint64_t carried = 0;  // adding one to the largest exponent carries into the sign
  for (const double value : values)
    carried |= (std::bit_cast<std::uint64_t>(value) & ~kSign) + kOne;
  return (carried & kSign) == 0;
}

/// `first`: index of the first of `values` among all frames' coordinates, `columns` each.
void check_finite(const std::string& path, std::span<const double> values, std::size_t first,
                  std::size_t columns) {
  if (all_finite(values)) return;
  while (std::isfinite(values[0])) {
    values = values.subspan(1);
    ++first;
  }
  throw IoError(path, "frame " + std::to_string(first / columns) + ": vertex " +
                          std::to_string(first % columns / 3) + " has no finite position");
}

std::span<double> coordinates_of(Frames& frames) {
  return {frames.data(), static_cast<std::size_t>(frames.size())};
}

/// Calls `work(first, count)` for pieces of `values` values that fit a processor's cache.
void for_each_piece(std::size_t values, int threads,
                    const std::function<void(std::size_t, std::size_t)>& work) {
  constexpr std::size_t kPiece = 1 << 15;
  const auto pieces = static_cast<int>((values + kPiece - 1) / kPiece);
  parallel_for(pieces, threads, [&](int piece) {
    const std::size_t first = kPiece * static_cast<std::size_t>(piece);
    work(first, std::min(kPiece, values - first));
  });
}

/// What an array starts with; all of its header in version 1.
std::string beginning_of(const InputFile& file) {
  constexpr std::size_t kMost = 1 << 17;
  std::string bytes(std::min(file.size(), kMost), '\0');
  file.read(0, bytes.data(), bytes.size());
  return bytes;
}

/// Straight into the frames: captures are large. None where the order is another one,
/// or the header may be of any length.
std::optional<Frames> read_in_place(const std::filesystem::path& path, int threads) {
  if (!InputFile::has_size(path)) return std::nullopt;
  const InputFile file(path);
  const std::string beginning = beginning_of(file);
  if (beginning.size() > kVersionAt && beginning[kVersionAt] != 1) return std::nullopt;
  const NpyHeader header = read_header(path.string(), beginning);
  check_frames_header(path.string(), header);
  const std::size_t count = checked_count(path.string(), file.size(), header);
  if (header.fortran_order) return std::nullopt;
  const std::size_t rows = header.shape.size() == 3 ? header.shape[0] : 1;
  const std::size_t columns = count / rows;
  Frames frames(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  const bool as_stored = header.item_bytes == 8 && header.order == std::endian::native;
  for_each_piece(count, threads, [&](std::size_t first, std::size_t values) {
    const std::span<double> piece = coordinates_of(frames).subspan(first, values);
    const std::size_t offset = header.data + first * header.item_bytes;
    if (as_stored) {
      file.read(offset, reinterpret_cast<char*>(piece.data()), piece.size_bytes());
    } else {
      std::vector<char> stored(values * header.item_bytes);
      file.read(offset, stored.data(), stored.size());
      decode(stored.data(), header, piece);
    }
    check_finite(path.string(), piece, first, columns);
  });
  return frames;
}

/// Version 1; padded so that the values start at a multiple of 64 bytes, as NumPy does.
std::string header_bytes(const Frames& frames, bool single_precision) {
  std::string text = std::string("{'descr': '<f") + (single_precision ? "4" : "8") +
                     "', 'fortran_order': False, 'shape': (" + std::to_string(frames.rows()) +
                     ", " + std::to_string(frames.cols() / 3) + ", 3), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;
  text.append((kAlignment - (kBefore + text.size() + 1) % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes.append({'\1', '\0'});
  append_little_endian(bytes, static_cast<std::uint16_t>(text.size()));
  return bytes + text;
}

template <typename Stored>
std::string encoded(std::span<const double> values) {
  std::string bytes(values.size() * sizeof(Stored), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    put_little_endian(bytes.data() + i * sizeof(Stored), static_cast<Stored>(values[i]));
  }
  return bytes;
}

}  // namespace

Frames read_npy_frames(const std::filesystem::path& path, int threads) {
  if (std::optional<Frames> frames = read_in_place(path, threads)) return *std::move(frames);
  const std::string bytes = read_file(path);
  const NpyHeader header = read_header(path.string(), bytes);
  check_frames_header(path.string(), header);
  Frames frames = frames_of(read_array(path.string(), bytes, header));
  check_finite(path.string(), coordinates_of(frames), 0, static_cast<std::size_t>(frames.cols()));
  return frames;
}

NumericArray read_npy(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return read_array(path.string(), bytes, read_header(path.string(), bytes));
}

void write_npy_frames(const std::filesystem::path& path, const Frames& frames,
                      bool single_precision, int threads) {
  const std::string header = header_bytes(frames, single_precision);
  OutputFile file(path);
  file.write({header});
  const auto count = static_cast<std::size_t>(frames.size());
  const bool as_stored = !single_precision && std::endian::native == std::endian::little;
  const std::size_t item_bytes = single_precision ? sizeof(float) : sizeof(double);
  for_each_piece(count, threads, [&](std::size_t first, std::size_t values) {
    const std::span<const double> piece(frames.data() + first, values);
    const std::size_t offset = header.size() + first * item_bytes;
    if (as_stored) {
      file.write_at(offset, {reinterpret_cast<const char*>(piece.data()), piece.size_bytes()});
    } else {
      file.write_at(offset, single_precision ? encoded<float>(piece) : encoded<double>(piece));
    }
  });
  file.close();
}

}  // namespace mimetra
