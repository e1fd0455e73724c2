#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace mimetra {

/// XXH3 (64 bits) of a file's bytes, as hexadecimal digits; empty where it cannot be read,
/// as what is no regular file.
std::string file_hash(const std::filesystem::path& path);

/// XXH3 of a file's size and its first and last 64 kB; 0 where it cannot be read.
std::uint64_t hash_of_ends(const std::filesystem::path& path);

}  // namespace mimetra
