#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Which folder of the project may use which: the table of dependencies as data, and what breaks
/// it.
namespace mimetra::test {

struct FolderRule {
  /// Path of the folder; its last part is its name in `<mimetra/NAME/...>` and `mimetra::NAME`.
  std::string path;
  /// Names of the folders it may use besides itself.
  std::vector<std::string> folders;
  /// Third parties of its .cpp files. Eigen is everywhere.
  std::vector<std::string> third_parties;
  /// Samples and shells inside a host program may use any third party.
  bool any_third_party = false;

  std::string name() const { return std::filesystem::path(path).filename().string(); }
};

/// Each folder uses only folders before it.
const std::vector<FolderRule>& folder_rules();

/// The rule for a file, by its path within the project; none for files between the folders.
const FolderRule* rule_for(const std::filesystem::path& file);

/// One message per `#include` of a source file that its folder's rule forbids.
std::vector<std::string> include_errors(const std::filesystem::path& file, const std::string& text);

/// One message per library named in a CMakeLists.txt that its folder's rule forbids.
std::vector<std::string> link_errors(const std::filesystem::path& file, const std::string& text);

}  // namespace mimetra::test
