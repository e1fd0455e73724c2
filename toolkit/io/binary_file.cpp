#include "toolkit/io/binary_file.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include "toolkit/io/temporary_name.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Calls `transfer`, which returns a number of bytes or -1, until `bytes` are done or none come.
/// Returns how many are done; -1 with errno for an error.
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

std::string last_reason() {
  return std::error_code(errno, std::generic_category()).message();
}

bool InputFile::has_size(const fs::path& path) {
  std::error_code unreadable;
  return fs::is_regular_file(path, unreadable) && fs::file_size(path, unreadable) > 0 &&
         !unreadable;
}

InputFile::InputFile(fs::path path) : path_(std::move(path)), file_(path_) {
  const off_t end = lseek(file_.descriptor(), 0, SEEK_END);
  if (end < 0) throw IoError(path_.string(), "cannot be read: " + last_reason());
  size_ = static_cast<std::size_t>(end);
}

void InputFile::read(std::size_t offset, char* to, std::size_t bytes) const {
  const ssize_t done = repeated(bytes, [&](std::size_t so_far) {
    return pread(file_.descriptor(), to + so_far, bytes - so_far,
                 static_cast<off_t>(offset + so_far));
  });
  if (done < 0) throw IoError(path_.string(), "cannot be read: " + last_reason());
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

}  // namespace mimetra
