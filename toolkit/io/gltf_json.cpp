#include "toolkit/io/gltf_json.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

GltfValue::GltfValue(const std::string& path, std::string where, const Json& json)
    : path_(&path), where_(std::move(where)), json_(&json) {}

void GltfValue::fail(const std::string& message) const {
  throw IoError(*path_, (where_.empty() ? "its JSON" : where_) + ": " + message);
}

bool GltfValue::has(const char* name) const {
  return json_->is_object() && json_->contains(name);
}

bool GltfValue::is_array() const {
  return json_->is_array();
}

bool GltfValue::is_text() const {
  return json_->is_string();
}

GltfValue GltfValue::at(const char* name) const {
  const auto found = object().find(name);
  if (found == json_->end()) fail(std::string("has no '") + name + "'");
  return {*path_, where_.empty() ? name : where_ + '.' + name, *found};
}

std::vector<GltfValue> GltfValue::list(const char* name) const {
  if (object().find(name) == json_->end()) return {};
  return at(name).items();
}

std::vector<GltfValue> GltfValue::items() const {
  if (!is_array()) fail("expected an array");
  std::vector<GltfValue> items;
  items.reserve(json_->size());
  for (const Json& item : *json_) {
    items.emplace_back(*path_, where_ + '[' + std::to_string(items.size()) + ']', item);
  }
  return items;
}

std::size_t GltfValue::count() const {
  // Up to here every integer is exact in JSON; no file is larger.
  constexpr double kMost = 9007199254740992.;
  const double value = number();
  if (value < 0 || value > kMost || value != std::floor(value)) {
    fail("is " + readable(value, 8) + ", expected a count");
  }
  return static_cast<std::size_t>(value);
}

std::size_t GltfValue::count_or(const char* name, std::size_t fallback) const {
  return has(name) ? count(name) : fallback;
}

std::size_t GltfValue::index(std::size_t size) const {
  const std::size_t value = count();
  if (value >= size) {
    fail("is " + std::to_string(value) + ", but there are " + std::to_string(size));
  }
  return value;
}

std::optional<std::size_t> GltfValue::maybe_index(const char* name, std::size_t size) const {
  if (!has(name)) return std::nullopt;
  return index(name, size);
}

double GltfValue::number() const {
  if (!json_->is_number()) fail("expected a number");
  const double value = json_->get<double>();
  if (!std::isfinite(value)) fail("is not finite");
  return value;
}

std::vector<double> GltfValue::numbers(const char* name) const {
  std::vector<double> values;
  for (const GltfValue& item : list(name)) values.push_back(item.number());
  return values;
}

std::string GltfValue::text() const {
  if (!is_text()) fail("expected text");
  return json_->get<std::string>();
}

std::string GltfValue::text_or(const char* name, const std::string& fallback) const {
  return has(name) ? at(name).text() : fallback;
}

std::string GltfValue::name() const {
  constexpr std::size_t kLongest = 1000;
  std::string text = this->text();
  if (text.size() > kLongest) fail("is a name of " + std::to_string(text.size()) + " bytes");
  return text;
}

bool GltfValue::flag(const char* name) const {
  if (!has(name)) return false;
  const GltfValue value = at(name);
  if (!value.json_->is_boolean()) value.fail("expected true or false");
  return value.json_->get<bool>();
}

std::optional<GltfValue> GltfValue::extension(const char* name) const {
  if (!has("extensions") || !at("extensions").has(name)) return std::nullopt;
  return at("extensions").at(name);
}

const Json& GltfValue::object() const {
  if (!json_->is_object()) fail("expected an object");
  return *json_;
}

namespace {

/// Start of a URI, short enough for a message.
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

/// Replaces %20 and similar codes by their characters.
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
  // Some file stores have folders of links into one folder with all files.
  const fs::path store = fs::weakly_canonical(path, unresolved).parent_path();
  if (!is_plain || !(is_inside(folder, folder / name) || is_inside(store, folder / name))) {
    throw IoError(path, "its buffer " + shown_uri(uri) +
                            " is no file in its own folder, and nothing else is read");
  }
  const fs::path file = fs::path(path).parent_path() / name;
  if (!is_there(file)) {
    return {{}, std::nullopt, "its buffer " + shown_uri(uri) + " is not there; keep both together"};
  }
  std::error_code unreadable;
  if (!fs::is_regular_file(file, unreadable)) {
    throw IoError(path, "its buffer " + shown_uri(uri) + " is not an ordinary file");
  }
  return {read_file(file), file};
}

}  // namespace mimetra
