#pragma once

#include <filesystem>
#include <vector>

namespace mimetra {

/// Name of the manifest in folders that mimetra writes.
inline constexpr const char* kFolderManifest = "mimetra-run.json";

/// Adds the list of all files below `folder` to its manifest, creating it if needed. Throws
/// OutputError.
void list_written_files(const std::filesystem::path& folder);

/// Files and empty folders below `folder` that its manifest does not list, relative to `folder` and
/// sorted by name. Without a list in the manifest, these are all files. Throws OutputError if a
/// folder cannot be read.
std::vector<std::filesystem::path> files_of_others(const std::filesystem::path& folder);

}  // namespace mimetra
