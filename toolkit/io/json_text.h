#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

/// The one way by which JSON comes in and goes out. Readers catch Json::exception for values of
/// another kind than they expect; what is no sound JSON never reaches them.
namespace mimetra {

/// JSON with its keys in the order they were added.
using Json = nlohmann::ordered_json;

/// The value that `text` holds; a byte order mark may stand before it. Throws IoError with `path`,
/// with what was `expected`, and with the line, for what is no JSON, is longer than 512 MB, nested
/// deeper than 100 levels, has a key twice in an object or more than 10000 of them, or a zero byte
/// in a string.
Json parse_json(const std::string& path, std::string_view text,
                const std::string& expected = "JSON");

/// The same from a file. Throws as read_file too.
Json read_json(const std::filesystem::path& path, const std::string& expected = "JSON");

/// The same; none where there is no such file, or no sound JSON in it.
std::optional<Json> read_json_if_any(const std::filesystem::path& path);

/// The text of a value, on one line or indented. Bytes that are no UTF-8 become U+FFFD, so that
/// no name ends a run.
std::string json_text(const Json& json, int indent = -1);

/// A value for messages: short, whatever it is.
std::string short_text(const Json& json);

}  // namespace mimetra
