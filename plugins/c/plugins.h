#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Folders that are searched for plugins: the folders of MIMETRA_PLUGIN_PATH, separated by ':',
/// then lib/mimetra/plugins of the running installation, if it exists.
std::vector<std::filesystem::path> plugin_folders();

/// True if root or the owner of `binary` owns `folder`, and it is not world-writable. This keeps a
/// program in a shared place from loading what others put above it.
bool is_of_installation(const std::filesystem::path& folder, const std::filesystem::path& binary);

/// Adds the operations and formats of all plugins (*.so) in these folders, ordered by folder and
/// file name. Skips what cannot be used and returns one line about each problem. Plugins stay
/// loaded until the process ends.
std::vector<std::string> add_plugins(OperationTable& table,
                                     const std::vector<std::filesystem::path>& folders);

}  // namespace mimetra
