#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Which folder of the project may use which, and how files include each other: the rules as data,
/// and what breaks them.
namespace mimetra::test {

struct FolderRule {
  std::string name;  ///< of its library, mimetra::NAME
  std::string path;
  /// Names of the folders it may use besides itself.
  std::vector<std::string> folders;
  /// Third parties of its .cpp files. Eigen is everywhere.
  std::vector<std::string> third_parties = {};
  /// Samples and shells inside a host program may use any third party.
  bool any_third_party = false;
};

/// Each folder uses only folders before it.
const std::vector<FolderRule>& folder_rules();

/// The rule for a file, by its path within the project; none for files between the folders.
const FolderRule* rule_for(const std::filesystem::path& file);

/// One message per `#include` of a source file that its folder's rule forbids.
std::vector<std::string> include_errors(const std::filesystem::path& file, const std::string& text);

/// One message per library named in a CMakeLists.txt that its folder's rule forbids.
std::vector<std::string> link_errors(const std::filesystem::path& file, const std::string& text);

/// Files by their paths within the project, and what they hold.
using Tree = std::map<std::filesystem::path, std::string>;

/// One message per `#include` of a source file, tests included, that is not written as the project
/// writes it: a file of the tree by its path from the root, in quotes; from programs that know an
/// installation only, as <mimetra/PATH>.
std::vector<std::string> path_errors(const Tree& sources);

/// One message per header that another folder includes and that the HEADERS of its CMakeLists.txt
/// do not name. `sources` are without tests, which may look inside.
std::vector<std::string> private_header_errors(const Tree& sources, const Tree& lists);

/// One message per header whose name another header has, too.
std::vector<std::string> name_errors(const Tree& sources);

/// The circles of files that include each other, by way of others too: a header and the source of
/// its name count as one. Empty where there is none; otherwise each as "a -> b -> a".
std::vector<std::string> circles(const Tree& sources);

}  // namespace mimetra::test
