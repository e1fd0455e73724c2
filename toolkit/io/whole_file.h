#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mimetra {

/// The bytes of a file, or of a pipe of the process. Throws IoError that says why not; Cancelled.
std::string read_file(const std::filesystem::path& path);

/// Writes `content` to `path` itself, replacing what is there. Not atomic. Throws OutputError.
void write_bytes(const std::filesystem::path& path, std::string_view content);

}  // namespace mimetra
