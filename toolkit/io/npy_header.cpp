#include "toolkit/io/npy_header.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "toolkit/io/bytes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

constexpr std::size_t kVersionAt = 6;

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

}  // namespace mimetra
