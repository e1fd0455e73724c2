#pragma once

#include <filesystem>
#include <string>

namespace mimetra {

/// XXH3 (64 bits) of a file's bytes, as hexadecimal digits; empty where it cannot be read,
/// as what is no regular file.
std::string file_hash(const std::filesystem::path& path);

}  // namespace mimetra
