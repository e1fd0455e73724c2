#include "toolkit/io/gltf_buffers.h"

#include <array>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// As much of a URI as a message can hold.
std::string shown_uri(const std::string& uri) {
  constexpr std::size_t kLongest = 60;
  return "'" + (uri.size() > kLongest ? uri.substr(0, kLongest) + "..." : uri) + "'";
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

std::string from_base64(const std::string& path, std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  unsigned held = 0;
  int bits = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) throw IoError(path, "a data URI is not base64");
    held = (held << 6 | static_cast<unsigned>(digit)) & 0xffffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xff);
  }
  return bytes;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// With %20 and the like as the characters they stand for.
std::string decoded_uri(std::string_view uri) {
  std::string text;
  for (std::size_t at = 0; at < uri.size(); ++at) {
    const int high = at + 2 < uri.size() ? hex_digit(uri[at + 1]) : -1;
    const int low = at + 2 < uri.size() ? hex_digit(uri[at + 2]) : -1;
    if (uri[at] != '%' || high < 0 || low < 0) {
      text += uri[at];
      continue;
    }
    text += static_cast<char>(16 * high + low);
    at += 2;
  }
  return text;
}

bool is_inside(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(file, error);
  const fs::path start = fs::weakly_canonical(folder, error);
  const fs::path relative = whole.lexically_relative(start);
  return !error && !relative.empty() && *relative.begin() != "..";
}

}  // namespace

GltfBuffer read_gltf_buffer(const std::string& path, const std::string& uri) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !lower_case(uri.substr(0, comma)).ends_with(";base64")) {
      throw IoError(path, "the data URI " + shown_uri(uri) + " is not base64");
    }
    return {from_base64(path, decoded_uri(std::string_view(uri).substr(comma + 1))), std::nullopt};
  }
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  const std::string name = decoded_uri(uri);
  const bool is_plain = !name.empty() && name.find('\0') == std::string::npos &&
                        name.find(':') == std::string::npos && fs::path(name).is_relative();
  std::error_code unresolved;
  // As stores of files have it: a folder of links to one that holds everything.
  const fs::path store = fs::weakly_canonical(path, unresolved).parent_path();
  if (!is_plain || !(is_inside(folder, folder / name) || is_inside(store, folder / name))) {
    throw IoError(path, "its buffer " + shown_uri(uri) +
                            " is no file in its own folder, and nothing else is read");
  }
  const fs::path file = fs::path(path).parent_path() / name;
  std::error_code unreadable;
  if (!fs::exists(file, unreadable)) {
    return {{}, std::nullopt, "its buffer " + shown_uri(uri) + " is not there; keep both together"};
  }
  if (!fs::is_regular_file(file, unreadable)) {
    throw IoError(path, "its buffer " + shown_uri(uri) + " is not an ordinary file");
  }
  return {read_file(file), file};
}

}  // namespace mimetra
