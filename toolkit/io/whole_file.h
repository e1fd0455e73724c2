#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mimetra {

/// The bytes of a file, or of a pipe of the process. Throws IoError that says why not; Cancelled.
std::string read_file(const std::filesystem::path& path);

/// Writes `content` to `path` itself, replacing what is there. Not atomic. Throws OutputError.
void write_bytes(const std::filesystem::path& path, std::string_view content);

/// True where something stands under a name. What cannot even be asked for, such as a name too
/// long, is not there.
bool is_there(const std::filesystem::path& path);

/// In normal form, so that "out/" and "out" are one name, whose folder is its parent.
std::filesystem::path without_trailing_slash(std::filesystem::path path);

/// Throws IoError for a path where nothing is, with the name of a file or folder beside it that is
/// nearly the same.
[[noreturn]] void fail_missing(const std::string& path);

/// What a file of a known kind that nothing here reads is by its extension: "an FBX scene". "" for
/// other files.
std::string_view kind_of_file(const std::filesystem::path& path);

/// That, and what to do with it: "an FBX scene; export it as ...". Also of glTF with an extension
/// that nobody knows.
std::string foreign_file(const std::filesystem::path& path);

}  // namespace mimetra
