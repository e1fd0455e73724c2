#include "toolkit/mesh/scratch_file.h"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail_to_keep(const fs::path& folder, const std::error_code& reason) {
  throw OutputError(folder.string(),
                    "cannot keep the numbers of this run for a while: " + reason.message() +
                        "; set TMPDIR to a folder on a disk with room for them");
}

std::error_code last_error() {
  return {errno, std::generic_category()};
}

fs::path folder_for_temporary_files() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  const char* named = std::getenv("TMPDIR");
  if (error) fail_to_keep(named ? named : "/tmp", error);
  return folder;
}

/// A file without a name.
int nameless_file(const fs::path& folder) {
  int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor >= 0) return descriptor;
  // Not every file system makes files without names.
  std::string name = (folder / "mimetra-XXXXXX").string();
  descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) fail_to_keep(folder, last_error());
  unlink(name.c_str());
  return descriptor;
}

/// Calls `transfer` with how many bytes are done until all are; returns false with errno where the
/// system refuses.
template <typename Transfer>
bool transferred(std::size_t bytes, const Transfer& transfer) {
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t now = transfer(done);
    if (now < 0 && errno == EINTR) continue;
    if (now == 0) errno = EIO;
    if (now <= 0) return false;
    done += static_cast<std::size_t>(now);
  }
  return true;
}

}  // namespace

ScratchFile::ScratchFile()
    : folder_(folder_for_temporary_files()), descriptor_(nameless_file(folder_)) {}

ScratchFile::~ScratchFile() {
  close(descriptor_);
}

void ScratchFile::write(std::size_t offset, std::span<const std::byte> bytes) {
  const auto write_some = [&](std::size_t done) {
    return pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                  static_cast<off_t>(offset + done));
  };
  if (!transferred(bytes.size(), write_some)) fail_to_keep(folder_, last_error());
}

void ScratchFile::read(std::size_t offset, std::span<std::byte> bytes) const {
  const auto read_some = [&](std::size_t done) {
    return pread(descriptor_, bytes.data() + done, bytes.size() - done,
                 static_cast<off_t>(offset + done));
  };
  if (transferred(bytes.size(), read_some)) return;
  throw IoError(folder_.string(),
                "numbers that were kept here cannot be read: " + last_error().message());
}

}  // namespace mimetra
