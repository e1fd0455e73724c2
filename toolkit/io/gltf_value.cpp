#include "toolkit/io/gltf_value.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

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
  // As far as every number of JSON is exact, which is far beyond any file.
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

}  // namespace mimetra
