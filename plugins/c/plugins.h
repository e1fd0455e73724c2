#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Where plugins are looked for: the folders of MIMETRA_PLUGIN_PATH, separated by ':', and
/// lib/mimetra/plugins of the installation that this code runs from, where there is one.
std::vector<std::filesystem::path> plugin_folders();

/// Adds the operations and formats of all plugins (*.so) in these folders, in the order of folders
/// and file names. Whatever cannot be used is left out, and the result says what and why, a line
/// each. Plugins stay loaded until the process ends.
std::vector<std::string> add_plugins(OperationTable& table,
                                     const std::vector<std::filesystem::path>& folders);

}  // namespace mimetra
