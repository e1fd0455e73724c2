#include "toolkit/io/written_files.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFiles = "files";

/// Manifest of a folder, or an empty object.
Json manifest_in(const fs::path& folder) {
  std::optional<Json> json = read_json_if_any(folder / kFolderManifest);
  return json && json->is_object() ? *std::move(json) : Json::object();
}

/// Files and empty folders below `folder`, relative to it. Links are not followed.
std::vector<fs::path> contents(const fs::path& folder) {
  std::vector<fs::path> paths;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const bool holds_others =
          !entry.is_symlink() && entry.is_directory() && !fs::is_empty(entry.path());
      if (!holds_others) paths.push_back(entry.path().lexically_relative(folder));
    }
  } catch (const fs::filesystem_error& error) {
    throw OutputError(error.path1().string(), "cannot be read: " + error.code().message());
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace

void list_written_files(const fs::path& folder) {
  Json manifest = manifest_in(folder);
  if (manifest.empty()) manifest["program"] = "mimetra";
  Json& files = manifest[kFiles] = Json::array();
  for (const fs::path& path : contents(folder)) {
    if (path != kFolderManifest) files.push_back(path.generic_string());
  }
  write_bytes(folder / kFolderManifest, json_text(manifest, 2) + '\n');
}

std::vector<fs::path> files_of_others(const fs::path& folder) {
  const Json manifest = manifest_in(folder);
  std::set<fs::path> listed;
  if (manifest.contains(kFiles) && manifest[kFiles].is_array()) {
    listed.insert(kFolderManifest);
    for (const Json& file : manifest[kFiles]) {
      if (file.is_string()) listed.insert(file.get<std::string>());
    }
  }
  std::vector<fs::path> others = contents(folder);
  std::erase_if(others, [&listed](const fs::path& path) { return listed.contains(path); });
  return others;
}

}  // namespace mimetra
