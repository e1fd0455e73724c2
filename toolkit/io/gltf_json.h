#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/json_text.h"

/// JSON of a glTF file and its buffers. Internal to the reader.
namespace mimetra {

/// One value of the file and, for messages, its place: "accessors[3].sparse". Functions throw
/// IoError for unexpected values.
class GltfValue {
 public:
  GltfValue(const std::string& path, std::string where, const Json& json);

  [[noreturn]] void fail(const std::string& message) const;

  bool has(const char* name) const;
  bool is_array() const;
  bool is_text() const;
  GltfValue at(const char* name) const;
  /// Values of an array; none if it is missing.
  std::vector<GltfValue> list(const char* name) const;
  std::vector<GltfValue> items() const;

  std::size_t count() const;
  std::size_t count(const char* name) const { return at(name).count(); }
  std::size_t count_or(const char* name, std::size_t fallback) const;

  /// Index below `size`.
  std::size_t index(std::size_t size) const;
  std::size_t index(const char* name, std::size_t size) const { return at(name).index(size); }
  std::optional<std::size_t> maybe_index(const char* name, std::size_t size) const;

  double number() const;
  std::vector<double> numbers(const char* name) const;
  template <std::size_t Size>
  std::array<double, Size> numbers_or(const char* name, std::array<double, Size> values) const {
    if (!has(name)) return values;
    const GltfValue given = at(name);
    const std::vector<GltfValue> items = given.items();
    if (items.size() != Size) {
      given.fail("has " + std::to_string(items.size()) + " numbers, expected " +
                 std::to_string(Size));
    }
    for (std::size_t i = 0; i < Size; ++i) values[i] = items[i].number();
    return values;
  }

  std::string text() const;
  std::string text_or(const char* name, const std::string& fallback) const;
  /// Text of at most 1000 bytes, because names may be copied many times.
  std::string name() const;
  std::string name_or_nothing() const { return has("name") ? at("name").name() : std::string(); }

  bool flag(const char* name) const;

  std::optional<GltfValue> extension(const char* name) const;

 private:
  const Json& object() const;

  const std::string* path_;
  std::string where_;
  const Json* json_;
};

struct GltfBuffer {
  std::string bytes;
  std::optional<std::filesystem::path> file;  ///< none for data URIs and missing files
  std::string missing = {};                   ///< error message if the file is missing
};

/// Reads the buffer `uri` of the glTF file `path`: base64 data, or a file in the folder of `path`.
/// Links may lead to the folder that `path` itself links to. Throws IoError, also for files
/// elsewhere; a missing file is only reported in `missing`.
GltfBuffer read_gltf_buffer(const std::string& path, const std::string& uri);

}  // namespace mimetra
