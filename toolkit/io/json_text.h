#pragma once

#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

/// Reads and writes all JSON of the project. Readers catch Json::exception for values of unexpected
/// types; malformed JSON is refused before they see it.
namespace mimetra {

/// JSON that keeps its keys in the order of insertion.
using Json = nlohmann::ordered_json;

/// Parses `text`, which may begin with a byte order mark. Throws IoError with `path`, what was
/// `expected` and, for syntax errors, the line. Refuses text longer than 512 MB, more than 100
/// nested levels, an object with a repeated key or more than 10000 keys, and zero bytes in strings.
Json parse_json(const std::string& path, std::string_view text,
                const std::string& expected = "JSON");

/// Reason of a Json::exception without the library's codes: "type must be string, but is number".
std::string json_reason(const std::exception& error);

/// Parses a file. Throws as parse_json() and read_file().
Json read_json(const std::filesystem::path& path, const std::string& expected = "JSON");

/// Parses a file; none if it cannot be read or is not valid JSON.
std::optional<Json> read_json_if_any(const std::filesystem::path& path);

/// Text of a value, on one line or indented. Bytes that are not UTF-8 become U+FFFD, so that no
/// name causes an error.
std::string json_text(const Json& json, int indent = -1);

/// Short text of any value, for messages.
std::string short_text(const Json& json);

}  // namespace mimetra
