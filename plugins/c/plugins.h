#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Where plugins are looked for: the folders of MIMETRA_PLUGIN_PATH, separated by ':', and
/// lib/mimetra/plugins of the installation that this code runs from, where there is one.
std::vector<std::filesystem::path> plugin_folders();

/// True where nobody can have put anything into `folder` but root and the owner of `binary`, so
/// that what lies above a program that was copied to a shared place is not run.
bool is_of_installation(const std::filesystem::path& folder, const std::filesystem::path& binary);

/// Adds the operations and formats of all plugins (*.so) in these folders, in the order of folders
/// and file names. Whatever cannot be used is left out, and the result says what and why, a line
/// each. Plugins stay loaded until the process ends.
std::vector<std::string> add_plugins(OperationTable& table,
                                     const std::vector<std::filesystem::path>& folders);

}  // namespace mimetra
