#include "plugins/c/plugins.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <set>
#include <sstream>

#include <dlfcn.h>
#include <sys/stat.h>

#include "plugins/c/crossing.h"
#include "plugins/c/plugin_description.h"
#include "toolkit/operations/this_process.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

fs::path folder_of_installation() {
  // The binary may be in bin, in lib, or in a host's folder below lib.
  constexpr int kLevels = 5;
  const fs::path binary = this_binary();
  fs::path folder = binary.parent_path();
  for (int level = 0; level < kLevels && folder.has_relative_path(); ++level) {
    std::error_code error;
    const fs::path plugins = folder / MIMETRA_PLUGIN_FOLDER;
    if (fs::is_directory(plugins, error) && is_of_installation(plugins, binary)) return plugins;
    folder = folder.parent_path();
  }
  return {};
}

std::vector<fs::path> libraries_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) throw UsageError("no such folder");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    const bool is_library = entry.path().extension() == ".so";
    // Reports links that lead nowhere, and ignores everything else that is not a file.
    if (is_library && (entry.is_regular_file(error) || error)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// Loads the description of a plugin. Throws UsageError for other libraries and versions.
mimetra_plugin loaded(const fs::path& file) {
  // RTLD_NOW reports missing symbols here instead of in a later run. The library stays loaded,
  // because its exceptions and exit handlers may be needed until the process ends.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw UsageError(dlerror());
  void* symbol = dlsym(library, "mimetra_get_plugin");
  if (!symbol) throw UsageError("has no function mimetra_get_plugin");
  const mimetra_plugin* plugin = reinterpret_cast<mimetra_get_plugin_function>(symbol)();
  if (!plugin) throw UsageError("mimetra_get_plugin returned NULL");
  const mimetra_plugin known = whole(*plugin);
  if (known.version != MIMETRA_INTERFACE_VERSION) {
    throw UsageError("is for version " + std::to_string(known.version) +
                     " of the interface, expected " + std::to_string(MIMETRA_INTERFACE_VERSION));
  }
  if (!known.name || !*known.name || !is_line(known.name)) throw UsageError("has no name");
  return known;
}

}  // namespace

bool is_of_installation(const fs::path& folder, const fs::path& binary) {
  struct stat of_folder = {}, of_binary = {};
  if (stat(folder.c_str(), &of_folder) != 0 || stat(binary.c_str(), &of_binary) != 0) return false;
  const bool is_own = of_folder.st_uid == 0 || of_folder.st_uid == of_binary.st_uid;
  return is_own && (of_folder.st_mode & S_IWOTH) == 0;
}

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  const char* named = std::getenv("MIMETRA_PLUGIN_PATH");
  std::istringstream list(named ? named : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  const fs::path installed = folder_of_installation();
  if (!installed.empty()) folders.push_back(installed);
  return folders;
}

std::vector<std::string> add_plugins(OperationTable& table, const std::vector<fs::path>& folders) {
  std::vector<std::string> problems;
  std::set<fs::path> seen;
  std::shared_ptr<const DescribedTable> toolkit;
  // Runs a step and reports what it throws as a problem of `place`.
  const auto attempt = [&problems](const fs::path& place, const auto& step) {
    try {
      step();
    } catch (...) {
      const std::string problem = failure_of(std::current_exception()).message;
      problems.push_back("plugins: " + place.string() + ": " + problem + "; it is left out");
    }
  };
  const auto add = [&](const fs::path& file) {
    const mimetra_plugin plugin = loaded(file);
    if (!toolkit) toolkit = std::make_shared<const DescribedTable>(add_toolkit);
    for (auto list = plugin.formats; list && *list; ++list) {
      attempt(file, [&] { table.add(plugin_format(whole(**list), plugin.name, toolkit)); });
    }
    for (auto list = plugin.operations; list && *list; ++list) {
      attempt(file, [&] { table.add(plugin_operation(whole(**list), plugin.name, toolkit)); });
    }
  };
  // Plugins may fill in their descriptions in mimetra_get_plugin().
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  for (const fs::path& folder : folders) {
    attempt(folder, [&] {
      for (const fs::path& file : libraries_in(folder)) {
        attempt(file, [&] {
          if (seen.insert(fs::canonical(file)).second) add(file);
        });
      }
    });
  }
  return problems;
}

}  // namespace mimetra
