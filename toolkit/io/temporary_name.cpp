#include "toolkit/io/temporary_name.h"

#include <atomic>
#include <string>
#include <string_view>

#include <unistd.h>

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kTemporary = ".tmp";

/// NAME of .NAME.123-4.tmp, of which NAME may again be such a name.
std::string without_temporary(std::string name) {
  while (name.starts_with('.') && name.ends_with(kTemporary)) {
    const std::size_t number = name.rfind('.', name.size() - kTemporary.size() - 1);
    if (number == 0 || number == std::string::npos) break;
    name = name.substr(1, number - 1);
  }
  return name;
}

}  // namespace

fs::path temporary_beside(const fs::path& target) {
  static std::atomic<int> counter = 0;
  return target.parent_path() / ("." + target.filename().string() + "." + std::to_string(getpid()) +
                                 "-" + std::to_string(counter++) + std::string(kTemporary));
}

fs::path committed_name(const fs::path& path) {
  fs::path name;
  for (const fs::path& part : path) name /= without_temporary(part.string());
  return name;
}

}  // namespace mimetra
