#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

/// Internal to the reader of glTF.
namespace mimetra {

/// One value of the file, and where it stands, for messages: "accessors[3].sparse". What is not
/// as expected throws IoError.
class GltfValue {
 public:
  GltfValue(const std::string& path, std::string where, const Json& json)
      : path_(&path), where_(std::move(where)), json_(&json) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(*path_, (where_.empty() ? "its JSON" : where_) + ": " + message);
  }

  bool has(const char* name) const { return json_->is_object() && json_->contains(name); }

  GltfValue at(const char* name) const {
    const auto found = object().find(name);
    if (found == json_->end()) fail(std::string("has no '") + name + "'");
    return {*path_, where_.empty() ? name : where_ + '.' + name, *found};
  }

  /// The values of an array; none where it is not there.
  std::vector<GltfValue> list(const char* name) const {
    if (object().find(name) == json_->end()) return {};
    return at(name).items();
  }

  std::vector<GltfValue> items() const {
    if (!json_->is_array()) fail("expected an array");
    std::vector<GltfValue> items;
    items.reserve(json_->size());
    for (const Json& item : *json_) {
      items.emplace_back(*path_, where_ + '[' + std::to_string(items.size()) + ']', item);
    }
    return items;
  }

  std::size_t count() const {
    // As far as every number of JSON is exact, which is far beyond any file.
    constexpr double kMost = 9007199254740992.;
    const double value = number();
    if (value < 0 || value > kMost || value != std::floor(value)) {
      fail("is " + readable(value, 8) + ", expected a count");
    }
    return static_cast<std::size_t>(value);
  }
  std::size_t count(const char* name) const { return at(name).count(); }
  std::size_t count_or(const char* name, std::size_t fallback) const {
    return has(name) ? count(name) : fallback;
  }

  /// The number of something that there are `size` of.
  std::size_t index(std::size_t size) const {
    const std::size_t value = count();
    if (value >= size) {
      fail("is " + std::to_string(value) + ", but there are " + std::to_string(size));
    }
    return value;
  }
  std::size_t index(const char* name, std::size_t size) const { return at(name).index(size); }
  std::optional<std::size_t> maybe_index(const char* name, std::size_t size) const {
    if (!has(name)) return std::nullopt;
    return index(name, size);
  }

  double number() const {
    if (!json_->is_number()) fail("expected a number");
    const double value = json_->get<double>();
    if (!std::isfinite(value)) fail("is not finite");
    return value;
  }

  template <std::size_t size>
  std::array<double, size> numbers_or(const char* name, std::array<double, size> values) const {
    if (!has(name)) return values;
    const GltfValue given = at(name);
    const std::vector<GltfValue> items = given.items();
    if (items.size() != size) {
      given.fail("has " + std::to_string(items.size()) + " numbers, expected " +
                 std::to_string(size));
    }
    for (std::size_t i = 0; i < size; ++i) values[i] = items[i].number();
    return values;
  }

  std::vector<double> numbers(const char* name) const {
    std::vector<double> values;
    for (const GltfValue& item : list(name)) values.push_back(item.number());
    return values;
  }

  std::string text() const {
    if (!json_->is_string()) fail("expected text");
    return json_->get<std::string>();
  }
  /// The same as a name, which may be copied many times.
  std::string name() const {
    constexpr std::size_t kLongest = 1000;
    std::string text = this->text();
    if (text.size() > kLongest) fail("is a name of " + std::to_string(text.size()) + " bytes");
    return text;
  }
  std::string name_or_nothing() const { return has("name") ? at("name").name() : std::string(); }
  std::string text_or(const char* name, const std::string& fallback) const {
    return has(name) ? at(name).text() : fallback;
  }

  bool flag(const char* name) const {
    if (!has(name)) return false;
    const GltfValue value = at(name);
    if (!value.json_->is_boolean()) value.fail("expected true or false");
    return value.json_->get<bool>();
  }

  std::optional<GltfValue> extension(const char* name) const {
    if (!has("extensions") || !at("extensions").has(name)) return std::nullopt;
    return at("extensions").at(name);
  }

 private:
  const Json& object() const {
    if (!json_->is_object()) fail("expected an object");
    return *json_;
  }

  const std::string* path_;
  std::string where_;
  const Json* json_;
};

}  // namespace mimetra
