#pragma once

#include <filesystem>
#include <vector>

namespace mimetra {

/// Name of the manifest in a folder that mimetra wrote.
inline constexpr const char* kFolderManifest = "mimetra-run.json";

/// Adds the list of all files below `folder` to its manifest, which is made where there is none.
/// Throws OutputError.
void list_written_files(const std::filesystem::path& folder);

/// Files and empty folders below `folder` that its manifest does not list, relative to it, in order
/// of their names: somebody else's. Without a manifest that lists files these are all. Throws
/// OutputError where a folder cannot be read.
std::vector<std::filesystem::path> files_of_others(const std::filesystem::path& folder);

}  // namespace mimetra
