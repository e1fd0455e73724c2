#include "toolkit/io/binary_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <random>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostOfAPipe = std::size_t{1} << 30;
/// PIPEFS_MAGIC of statfs(2): the file system of pipes without a name.
constexpr long kPipesWithoutName = 0x50495045;

/// Reason why the last system call failed.
std::string last_reason() {
  return std::error_code(errno, std::generic_category()).message();
}

/// Reason why a file of this type is not read; empty for a regular file.
std::string other_type(const struct stat& status) {
  if (S_ISREG(status.st_mode)) return "";
  if (S_ISDIR(status.st_mode)) return "is a folder, expected a file";
  if (S_ISFIFO(status.st_mode)) return "is a named pipe, expected a file";
  if (S_ISSOCK(status.st_mode)) return "is a socket, expected a file";
  return "is a device, expected a file";
}

std::string reading_problem() {
  return "cannot be read: " + last_reason();
}

/// True for the pointer that Git LFS leaves in place of a file that was not fetched.
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
  // One byte more than the file has, so that the first pass reaches its end. Pipes have no size,
  // and some system files report a wrong one. Both are read until they end.
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

namespace {

/// Calls `transfer`, which returns a number of bytes or -1, until all `bytes` are transferred or it
/// returns 0. Returns the number transferred, or -1 with errno.
template <typename Transfer>
ssize_t repeated(std::size_t bytes, const Transfer& transfer) {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t now = transfer(done);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) return -1;
    if (now == 0) break;
    done += static_cast<std::size_t>(now);
  }
  return static_cast<ssize_t>(done);
}

}  // namespace

bool InputFile::has_size(const fs::path& path) {
  std::error_code unreadable;
  return fs::is_regular_file(path, unreadable) && fs::file_size(path, unreadable) > 0 &&
         !unreadable;
}

InputFile::InputFile(fs::path path) : path_(std::move(path)), file_(path_) {
  const off_t end = lseek(file_.descriptor(), 0, SEEK_END);
  if (end < 0) throw IoError(path_.string(), reading_problem());
  size_ = static_cast<std::size_t>(end);
}

void InputFile::read(std::size_t offset, char* to, std::size_t bytes) const {
  const ssize_t done = repeated(bytes, [&](std::size_t so_far) {
    return pread(file_.descriptor(), to + so_far, bytes - so_far,
                 static_cast<off_t>(offset + so_far));
  });
  if (done < 0) throw IoError(path_.string(), reading_problem());
  if (static_cast<std::size_t>(done) < bytes) {
    throw IoError(path_.string(), "is truncated: it became shorter while it was read");
  }
}

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)),
      descriptor_(open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail();
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::initializer_list<std::string_view> pieces) {
  std::vector<iovec> left;
  std::size_t bytes = 0;
  for (const std::string_view piece : pieces) {
    if (piece.empty()) continue;
    left.push_back({const_cast<char*>(piece.data()), piece.size()});
    bytes += piece.size();
  }
  auto next = left.begin();
  const ssize_t done = repeated(bytes, [&](std::size_t) {
    const ssize_t now = writev(descriptor_, &*next, static_cast<int>(left.end() - next));
    for (auto rest = static_cast<std::size_t>(now > 0 ? now : 0); rest > 0;) {
      const std::size_t of_this = std::min(rest, next->iov_len);
      next->iov_base = static_cast<char*>(next->iov_base) + of_this;
      next->iov_len -= of_this;
      rest -= of_this;
      if (next->iov_len == 0) ++next;
    }
    return now;
  });
  if (done != static_cast<ssize_t>(bytes)) fail();
}

void OutputFile::write_at(std::size_t offset, std::string_view content) const {
  const ssize_t done = repeated(content.size(), [&](std::size_t so_far) {
    return pwrite(descriptor_, content.data() + so_far, content.size() - so_far,
                  static_cast<off_t>(offset + so_far));
  });
  if (done != static_cast<ssize_t>(content.size())) fail();
}

void OutputFile::close() {
  if (::close(std::exchange(descriptor_, -1)) != 0) fail();
}

void OutputFile::fail() const {
  throw OutputError(committed_name(path_).string(), "cannot be written: " + last_reason());
}

namespace {

constexpr std::string_view kTemporary = ".tmp";

/// Returns NAME for .NAME.0123456789abcdef.tmp. NAME may itself be such a name and is then
/// shortened as well.
std::string without_temporary(std::string name) {
  while (name.starts_with('.') && name.ends_with(kTemporary)) {
    const std::size_t number = name.rfind('.', name.size() - kTemporary.size() - 1);
    if (number == 0 || number == std::string::npos) break;
    name = name.substr(1, number - 1);
  }
  return name;
}

/// Random text for names that nobody can guess. Process numbers are predictable: in a container
/// every program has number 1.
std::string unguessable() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string text(16, '0');
  for (char& digit : text) digit = kDigits[random() % kDigits.size()];
  return text;
}

/// Creates an empty file or folder. Returns 0 or the errno.
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
  // Returning a copy could run out of memory and leave the new file behind.
  if (error) path.clear();
  return path;
}

fs::path committed_name(const fs::path& path) {
  fs::path name;
  for (const fs::path& part : path) name /= without_temporary(part.string());
  return name;
}

}  // namespace mimetra
