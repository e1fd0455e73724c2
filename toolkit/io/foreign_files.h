#pragma once

#include <filesystem>
#include <string>

namespace mimetra {

/// What a file of a known kind that nothing here reads is, and what to do with it, by its
/// extension: "an FBX scene; export it as ...". Also of glTF with an extension that nobody knows.
/// "" for other files.
std::string foreign_file(const std::filesystem::path& path);

}  // namespace mimetra
