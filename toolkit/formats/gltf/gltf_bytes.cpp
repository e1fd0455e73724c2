#include "toolkit/formats/gltf/gltf_bytes.h"

#include <charconv>

#include "toolkit/io/bytes.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

GltfChunks gltf_chunks(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  if (!bytes.starts_with("glTF")) return {bytes, {}};
  const auto word = [&](std::size_t at) {
    if (at + 4 > bytes.size()) throw IoError(path, "is truncated in a header");
    return number_at<std::uint32_t>(bytes.data() + at, std::endian::little);
  };
  if (word(4) != 2) {
    throw IoError(path, "is glTF " + std::to_string(word(4)) + ", and only version 2 is read");
  }
  if (word(8) > bytes.size()) {
    throw IoError(path, "is truncated: " + std::to_string(bytes.size()) + " bytes, expected " +
                            std::to_string(word(8)));
  }
  bytes = bytes.substr(0, word(8));
  GltfChunks chunks;
  for (std::size_t at = kHeader; at < bytes.size();) {
    const std::size_t size = word(at), start = at + kChunkHeader;
    const std::uint32_t type = word(at + 4);
    if (size > bytes.size() - start) throw IoError(path, "a chunk is longer than the file");
    if (at == kHeader && type != kJson) throw IoError(path, "does not start with JSON");
    if (at == kHeader) chunks.json = bytes.substr(start, size);
    if (type == kBinary && !chunks.binary) chunks.binary = bytes.substr(start, size);
    at = start + size;
  }
  return chunks;
}

namespace {

std::string from_base64(const std::string& path, std::string_view text) {
  // The last two digits are those of URLs.
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/-_";
  std::string bytes;
  unsigned held = 0;
  int bits = 0;
  for (const char c : text.substr(0, text.find_last_not_of('=') + 1)) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) throw IoError(path, "a data URI is not base64");
    held = (held << 6 | static_cast<unsigned>(digit < 64 ? digit : digit - 2)) & 0xffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xff);
  }
  return bytes;
}

/// Replaces %20 and similar codes by their characters.
std::string decoded_uri(std::string_view uri) {
  std::string text;
  for (std::size_t at = 0; at < uri.size(); ++at) {
    const std::string_view digits = uri.substr(at + 1, 2);
    const char* end = digits.data() + digits.size();
    unsigned char code = 0;
    const bool is_code = uri[at] == '%' && digits.size() == 2 &&
                         std::from_chars(digits.data(), end, code, 16).ptr == end;
    text += is_code ? static_cast<char>(code) : uri[at];
    if (is_code) at += 2;
  }
  return text;
}

}  // namespace

GltfBuffer read_gltf_buffer(const std::string& path, const std::string& uri) {
  constexpr std::size_t kLongestShown = 60;
  const std::string shown = "its buffer '" + uri.substr(0, kLongestShown) + "' ";
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !lower_case(uri.substr(0, comma)).ends_with(";base64")) {
      throw IoError(path, shown + "is not base64");
    }
    return {from_base64(path, decoded_uri(std::string_view(uri).substr(comma + 1))), {}, {}};
  }
  const std::string name = decoded_uri(uri);
  const fs::path file = fs::path(path).parent_path() / name;
  const auto is_inside = [&](const fs::path& folder) {
    std::error_code error;
    const fs::path inside = fs::weakly_canonical(fs::absolute(file), error)
                                .lexically_relative(fs::weakly_canonical(folder, error));
    return !error && !inside.empty() && *inside.begin() != "..";
  };
  const bool is_plain = !name.empty() && fs::path(name).is_relative() &&
                        name.find_first_of(std::string_view(":\0", 2)) == std::string::npos;
  // Some file stores have folders of links into one folder with all files.
  if (!is_plain || !(is_inside(fs::absolute(path).parent_path()) ||
                     is_inside(fs::weakly_canonical(path).parent_path()))) {
    throw IoError(path, shown + "is not in its own folder, and nothing else is read");
  }
  if (!is_there(file)) return {{}, shown + "is not there; keep both together", {}};
  return {read_file(file), {}, file};
}

}  // namespace mimetra
