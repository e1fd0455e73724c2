#include "toolkit/io/zip_archive.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <mutex>

#include <zip.h>

#include "toolkit/io/opened_file.h"
#include "toolkit/io/temporary_name.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

struct OpenZip {
  fs::path path;
  zip_t* archive = nullptr;
  /// The library serves one thread at a time.
  std::mutex mutex;

  ~OpenZip() {
    if (archive) zip_discard(archive);
  }
  [[noreturn]] void fail(const std::string& name, const std::string& reason) const {
    throw IoError(path.string(), "its member " + name + " cannot be read: " + reason);
  }
};

namespace {

std::string zip_reason(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  return reason;
}

/// A member that is not compressed.
class StoredMember : public InputBytes {
 public:
  StoredMember(std::shared_ptr<OpenZip> zip, std::string name, zip_file_t* file, std::size_t size)
      : zip_(std::move(zip)), name_(std::move(name)), file_(file), size_(size) {}
  ~StoredMember() override {
    const std::lock_guard lock(zip_->mutex);
    zip_fclose(file_);
  }

  std::size_t size() const override { return size_; }

  void read(std::size_t offset, char* to, std::size_t bytes) const override {
    if (offset > size_ || bytes > size_ - offset) zip_->fail(name_, "it is truncated");
    if (bytes == 0) return;  // the library crashes where it seeks in a member without bytes
    const std::lock_guard lock(zip_->mutex);
    if (zip_fseek(file_, static_cast<zip_int64_t>(offset), SEEK_SET) != 0) fail();
    for (std::size_t done = 0; done < bytes;) {
      const zip_int64_t now = zip_fread(file_, to + done, bytes - done);
      if (now < 0) fail();
      if (now == 0) zip_->fail(name_, "it is truncated");
      done += static_cast<std::size_t>(now);
    }
  }

 private:
  [[noreturn]] void fail() const { zip_->fail(name_, zip_file_strerror(file_)); }

  std::shared_ptr<OpenZip> zip_;
  std::string name_;
  zip_file_t* file_;
  std::size_t size_;
};

/// What a reader asks for first, to see whether the rest is what it expects.
constexpr std::size_t kBeginning = std::size_t{1} << 17;

/// A compressed member: its beginning is decoded alone, all of it once more is asked for.
class DeflatedMember : public InputBytes {
 public:
  DeflatedMember(std::shared_ptr<OpenZip> zip, std::string name, zip_file_t* file, std::size_t size)
      : zip_(std::move(zip)), name_(std::move(name)), file_(file), size_(size) {}
  ~DeflatedMember() override {
    const std::lock_guard lock(zip_->mutex);
    zip_fclose(file_);
  }

  std::size_t size() const override { return size_; }

  void read(std::size_t offset, char* to, std::size_t bytes) const override {
    if (offset > size_ || bytes > size_ - offset) zip_->fail(name_, "it is truncated");
    const std::lock_guard lock(zip_->mutex);
    const std::size_t end = offset + bytes;
    if (bytes_.size() < end) decode(end <= kBeginning ? std::min(kBeginning, size_) : size_);
    std::memcpy(to, bytes_.data() + offset, bytes);
  }

 private:
  void decode(std::size_t end) const {
    std::size_t done = bytes_.size();
    bytes_.resize(end);
    while (done < end) {
      const zip_int64_t now = zip_fread(file_, bytes_.data() + done, end - done);
      if (now <= 0) fail(now == 0 ? "it is truncated" : zip_file_strerror(file_));
      done += static_cast<std::size_t>(now);
    }
    char beyond = 0;
    // Only behind the last byte does the library compare checksums.
    if (end == size_ && zip_fread(file_, &beyond, 1) < 0) fail(zip_file_strerror(file_));
  }

  [[noreturn]] void fail(const std::string& reason) const {
    bytes_.clear();
    zip_->fail(name_, reason);
  }

  std::shared_ptr<OpenZip> zip_;
  std::string name_;
  zip_file_t* file_;
  std::size_t size_;
  mutable std::string bytes_;
};

/// Deflate makes nothing more than about a thousand times smaller: a larger claim is a lie, found
/// before memory is asked for.
constexpr std::size_t kMostDeflated = 1100;

/// Members of more than 1 GB may unpack to 512 times their stored bytes: a small file must not fill
/// the memory.
constexpr std::size_t kUnpackedBytes = std::size_t{1} << 30, kUnpackedShare = 512;

}  // namespace

ZipReader::ZipReader(const fs::path& path) : zip_(std::make_shared<OpenZip>()) {
  require_regular_file(path);
  zip_->path = path;
  int error = 0;
  zip_->archive = zip_open(path.c_str(), ZIP_RDONLY, &error);
  if (!zip_->archive) throw IoError(path.string(), "is no ZIP archive: " + zip_reason(error));
}

ZipReader::~ZipReader() = default;

std::vector<std::string> ZipReader::names() const {
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(zip_->archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(zip_->archive, static_cast<zip_uint64_t>(i), 0);
    if (name) names.emplace_back(name);
  }
  return names;
}

std::unique_ptr<const InputBytes> ZipReader::member(const std::string& name) const {
  const std::lock_guard lock(zip_->mutex);
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(zip_->archive, name.c_str(), 0, &stat) != 0) {
    zip_->fail(name, zip_strerror(zip_->archive));
  }
  // Both sizes are claims of the archive's.
  const bool stored = stat.comp_method == ZIP_CM_STORE;
  if (stat.comp_size > fs::file_size(zip_->path) ||
      stat.size / (stored ? 1 : kMostDeflated) > stat.comp_size) {
    zip_->fail(name, "it lies about its size");
  }
  if (stat.size > kUnpackedBytes && stat.size / kUnpackedShare > stat.comp_size) {
    zip_->fail(name, "it would take " + readable(static_cast<double>(stat.size) / 1e6, 3) +
                         " MB, more than " + std::to_string(kUnpackedShare) +
                         " times what is stored");
  }
  std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen(zip_->archive, name.c_str(), 0),
                                                          zip_fclose);
  if (!file) zip_->fail(name, zip_strerror(zip_->archive));
  if (stored) {
    return std::make_unique<const StoredMember>(zip_, name, file.release(), stat.size);
  }
  return std::make_unique<const DeflatedMember>(zip_, name, file.release(), stat.size);
}

struct ZipWriter::State {
  fs::path path;
  zip_t* archive = nullptr;
  /// Members' bytes, which the library reads when it closes the archive.
  std::deque<std::string> contents;

  ~State() {
    if (archive) zip_discard(archive);
  }
  void add(const std::string& name, zip_source_t* source) {
    // The first day that an archive can name, so that bytes depend on nothing but the content.
    constexpr zip_uint16_t kFirstDate = 1 << 5 | 1;
    if (!source) fail();
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      fail();
    }
    const auto place = static_cast<zip_uint64_t>(index);
    // A file that anybody reads, whatever the umask.
    constexpr zip_uint32_t kMode = 0100644U << 16;
    if (zip_set_file_compression(archive, place, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_external_attributes(archive, place, 0, ZIP_OPSYS_UNIX, kMode) != 0 ||
        zip_file_set_dostime(archive, place, 0, kFirstDate, 0) != 0) {
      fail();
    }
  }
  [[noreturn]] void fail() const {
    throw OutputError(committed_name(path).string(),
                      std::string("cannot be written: ") + zip_strerror(archive));
  }
};

ZipWriter::ZipWriter(fs::path path) : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  int error = 0;
  state_->archive = zip_open(state_->path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (!state_->archive) {
    throw OutputError(committed_name(state_->path).string(),
                      "cannot be written: " + zip_reason(error));
  }
}

ZipWriter::~ZipWriter() = default;

void ZipWriter::add(const std::string& name, std::string bytes) {
  const std::string& kept = state_->contents.emplace_back(std::move(bytes));
  state_->add(name, zip_source_buffer(state_->archive, kept.data(), kept.size(), 0));
}

void ZipWriter::add_file(const std::string& name, const fs::path& file) {
  state_->add(name, zip_source_file(state_->archive, file.c_str(), 0, -1));
}

void ZipWriter::close() {
  if (zip_close(state_->archive) != 0) state_->fail();
  state_->archive = nullptr;
}

}  // namespace mimetra
