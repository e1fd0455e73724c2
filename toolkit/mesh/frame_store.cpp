#include "toolkit/mesh/frame_store.h"

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

int nameless_file(const fs::path& folder) {
  int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor >= 0) return descriptor;
  // Not every file system supports files without names.
  std::string name = (folder / "mimetra-XXXXXX").string();
  descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) fail_to_keep(folder, last_error());
  unlink(name.c_str());
  return descriptor;
}

/// Calls `transfer` with the number of bytes done until all are done. Returns false, with errno
/// set, if the system refuses.
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

std::size_t byte_of(int frame, Eigen::Index columns) {
  return sizeof(double) * static_cast<std::size_t>(frame * columns);
}

template <typename Poses>
auto numbers_of(Poses&& poses) {
  return std::span(poses.data(), static_cast<std::size_t>(poses.size()));
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

FrameStore::FrameStore(SequenceHeader header, std::size_t memory_bytes)
    : FrameSource(std::move(header)) {
  const Eigen::Index columns = 3 * Eigen::Index{vertices()};
  if (byte_of(frames(), columns) <= memory_bytes) {
    memory_ = std::make_shared<Frames>(frames(), columns);
  } else {
    file_.emplace();
  }
}

void FrameStore::write(int first, const Frames& poses) {
  check_run(first, poses.rows());
  if (memory_) {
    memory_->middleRows(first, poses.rows()) = poses;
  } else {
    file_->write(byte_of(first, poses.cols()), std::as_bytes(numbers_of(poses)));
  }
}

void FrameStore::read_frames(int first, FramesView poses) const {
  if (memory_) {
    poses = memory_->middleRows(first, poses.rows());
  } else {
    file_->read(byte_of(first, poses.cols()), std::as_writable_bytes(numbers_of(poses)));
  }
}

void FrameStore::read_some_vertices(int first, VertexIndex vertex, FramesView poses) const {
  if (memory_) {
    poses = memory_->block(first, 3 * Eigen::Index{vertex}, poses.rows(), poses.cols());
    return;
  }
  for (Eigen::Index row = 0; row < poses.rows(); ++row) {
    const auto frame = first + static_cast<int>(row);
    file_->read(byte_of(frame, 3 * Eigen::Index{vertices()}) + byte_of(vertex, 3),
                std::as_writable_bytes(numbers_of(poses.row(row))));
  }
}

std::shared_ptr<const FrameSource> stored(std::shared_ptr<const FrameSource> source,
                                          const Context& context) {
  if (source->is_quick()) return source;
  auto store = std::make_shared<FrameStore>(source->header());
  for_each_block(
      *source, [&](int first, const Frames& poses) { store->write(first, poses); }, context);
  store->commit();
  return store;
}

}  // namespace mimetra
