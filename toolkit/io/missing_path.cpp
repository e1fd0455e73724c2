#include "toolkit/io/missing_path.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/suggestion.h"

namespace mimetra {
namespace fs = std::filesystem;

void fail_missing(const std::string& path) {
  if (path == "-") {
    throw IoError(path, "standard input is not read; expected a file or folder of that name");
  }
  const std::string message = "no such file or folder";
  const fs::path named = (fs::path(path) / "").parent_path();
  std::vector<std::string> names;
  std::error_code unreadable;
  for (fs::directory_iterator entry(named.has_parent_path() ? named.parent_path() : ".",
                                    unreadable);
       !unreadable && entry != fs::directory_iterator(); entry.increment(unreadable)) {
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  // Any short name is near to another, and a hidden file is seldom meant.
  constexpr std::size_t kTelling = 3;
  const std::string asked = named.filename().string();
  if (!asked.starts_with('.')) {
    std::erase_if(names, [](const std::string& name) { return name.starts_with('.'); });
  }
  // Names of one kind of file are alike by their endings.
  const std::string stem = named.stem().string();
  std::erase_if(names, [&stem](const std::string& name) {
    return nearest_word(stem, {fs::path(name).stem().string()}).empty();
  });
  const std::string nearest = asked.size() < kTelling ? "" : nearest_word(asked, names);
  if (nearest.empty()) throw IoError(path, message);
  throw IoError(path,
                message + "; did you mean '" + (named.parent_path() / nearest).string() + "'?");
}

}  // namespace mimetra
