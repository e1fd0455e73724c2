#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mimetra {

/// Bytes of a file, or of a pipe of the process. Throws IoError with the reason; Cancelled.
std::string read_file(const std::filesystem::path& path);

/// Writes `content` directly to `path`, replacing an existing file. Not atomic. Throws OutputError.
void write_bytes(const std::filesystem::path& path, std::string_view content);

/// True if the path exists. Paths that cannot be queried, such as too long ones, do not exist.
bool is_there(const std::filesystem::path& path);

/// Normal form without a trailing slash, so that "out/" and "out" are one name with the same
/// parent.
std::filesystem::path without_trailing_slash(std::filesystem::path path);

/// Throws IoError for a path that does not exist, and suggests a file or folder with a similar
/// name.
[[noreturn]] void fail_missing(const std::string& path);

/// Kind of a file by its extension, such as "an FBX scene"; "" if unknown.
std::string_view kind_of_file(const std::filesystem::path& path);

/// Kind of a file that cannot be read as a sequence, and advice: "an FBX scene; export it as ...".
/// Also detects glTF with an unknown extension. "" for other files.
std::string foreign_file(const std::filesystem::path& path);

}  // namespace mimetra
