#include "toolkit/io/opened_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr std::size_t kMostOfAPipe = std::size_t{1} << 30;
/// statfs(2): PIPEFS_MAGIC, where pipes without a name are.
constexpr long kPipesWithoutName = 0x50495045;

/// Why this is not read; empty for a regular file.
std::string other_type(const struct stat& status) {
  if (S_ISREG(status.st_mode)) return "";
  if (S_ISDIR(status.st_mode)) return "is a folder, expected a file";
  if (S_ISFIFO(status.st_mode)) return "is a named pipe, expected a file";
  if (S_ISSOCK(status.st_mode)) return "is a socket, expected a file";
  return "is a device, expected a file";
}

std::string reading_problem() {
  return "cannot be read: " + std::error_code(errno, std::generic_category()).message();
}

/// True for what Git LFS leaves where the file itself was not fetched.
bool is_lfs_pointer(int file) {
  constexpr std::string_view kBeginning = "version https://git-lfs";
  std::array<char, kBeginning.size()> bytes{};
  return pread(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()) &&
         std::string_view(bytes.data(), bytes.size()) == kBeginning;
}

bool has_no_name(int pipe) {
  struct statfs system;
  return fstatfs(pipe, &system) == 0 && static_cast<long>(system.f_type) == kPipesWithoutName;
}

}  // namespace

OpenedFile::OpenedFile(const std::filesystem::path& path)
    : path_(path.string()), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status;
  std::string problem;
  if (descriptor_ < 0) {
    problem = errno == ENOENT ? "no such file" : reading_problem();
    if (errno == ENXIO && stat(path.c_str(), &status) == 0)
      problem = other_type(status);  // a socket
  } else if (fstat(descriptor_, &status) != 0) {
    problem = reading_problem();
  } else {
    is_pipe_ = S_ISFIFO(status.st_mode) && has_no_name(descriptor_);
    if (!is_pipe_) problem = other_type(status);
    if (!is_pipe_ && problem.empty() && is_lfs_pointer(descriptor_)) {
      problem = "is a pointer of Git LFS, not the file itself; 'git lfs pull' fetches it";
    }
  }
  if (problem.empty()) return;
  if (descriptor_ >= 0) close(descriptor_);
  throw IoError(path_, problem);
}

OpenedFile::~OpenedFile() {
  close(descriptor_);
}

std::size_t OpenedFile::next(char* to, std::size_t most) const {
  while (true) {
    const ssize_t now = read(descriptor_, to, most);
    if (now >= 0) return static_cast<std::size_t>(now);
    if (errno == EINTR) continue;
    if (errno != EAGAIN) throw IoError(path_, reading_problem());
    pollfd wanted{descriptor_, POLLIN, 0};
    if (poll(&wanted, 1, -1) < 0 && errno == EINTR) throw Cancelled();
  }
}

std::string OpenedFile::rest() const {
  // One byte more than the file has, to meet its end at the first reading. A pipe has no size, and
  // some files of the system none that is true: they are read to their end, whatever it says.
  constexpr std::size_t kBlock = 1 << 16;
  struct stat status;
  const bool has_size = !is_pipe_ && fstat(descriptor_, &status) == 0 && status.st_size > 0;
  const std::size_t block =
      std::max(has_size ? static_cast<std::size_t>(status.st_size) + 1 : 0, kBlock);
  std::string content;
  std::size_t size = 0;
  while (true) {
    if (content.size() == size) content.resize(size + block);
    const std::size_t now = next(content.data() + size, content.size() - size);
    size += now;
    if (now == 0) break;
    if (is_pipe_ && size > kMostOfAPipe) {
      throw IoError(path_, "more than 1 GB comes through the pipe; save it as a file");
    }
  }
  content.resize(size);
  return content;
}

void require_regular_file(const std::filesystem::path& path) {
  if (OpenedFile(path).is_pipe()) {
    throw IoError(path.string(), "is a pipe, and this format is read at several places; save it");
  }
}

}  // namespace mimetra
