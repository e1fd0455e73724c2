#include "toolkit/io/temporary_name.h"

#include <cerrno>
#include <random>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kTemporary = ".tmp";

/// NAME of .NAME.0123456789abcdef.tmp, of which NAME may again be such a name.
std::string without_temporary(std::string name) {
  while (name.starts_with('.') && name.ends_with(kTemporary)) {
    const std::size_t number = name.rfind('.', name.size() - kTemporary.size() - 1);
    if (number == 0 || number == std::string::npos) break;
    name = name.substr(1, number - 1);
  }
  return name;
}

/// That nobody guesses: in a container every process has the number 1.
std::string unguessable() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string text(16, '0');
  for (char& digit : text) digit = kDigits[random() % kDigits.size()];
  return text;
}

/// 0, or why it could not be made.
int make(const fs::path& path, OutputKind kind) {
  if (kind == OutputKind::folder) return mkdir(path.c_str(), 0777) == 0 ? 0 : errno;
  const int file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  return close(file) == 0 ? 0 : errno;
}

}  // namespace

fs::path make_temporary_beside(const fs::path& target, OutputKind kind, std::error_code& error) {
  fs::path path;
  int reason = EEXIST;
  for (int attempt = 0; attempt < 100 && reason == EEXIST; ++attempt) {
    path = target.parent_path() /
           ("." + target.filename().string() + "." + unguessable() + std::string(kTemporary));
    reason = make(path, kind);
  }
  error = std::error_code(reason, std::generic_category());
  return reason == 0 ? path : fs::path();
}

fs::path committed_name(const fs::path& path) {
  fs::path name;
  for (const fs::path& part : path) name /= without_temporary(part.string());
  return name;
}

}  // namespace mimetra
