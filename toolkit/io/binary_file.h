#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "toolkit/io/opened_file.h"

/// Files of which parts are read and written, from several threads where wanted. Internal to the
/// readers and writers of large files.
namespace mimetra {

/// Why the last call to the operating system failed.
std::string last_reason();

/// Bytes of which parts are read, from several threads.
class InputBytes {
 public:
  InputBytes() = default;
  virtual ~InputBytes() = default;
  InputBytes(const InputBytes&) = delete;
  InputBytes& operator=(const InputBytes&) = delete;

  virtual std::size_t size() const = 0;
  /// Copies `bytes` bytes from `offset` on. Throws IoError, also where they end before.
  virtual void read(std::size_t offset, char* to, std::size_t bytes) const = 0;
};

/// An ordinary file that is open for reading.
class InputFile : public InputBytes {
 public:
  /// True for a file whose size is that of its content: no pipe, and nothing that seems empty.
  static bool has_size(const std::filesystem::path& path);

  /// Throws IoError.
  explicit InputFile(std::filesystem::path path);

  std::size_t size() const override { return size_; }
  void read(std::size_t offset, char* to, std::size_t bytes) const override;

 private:
  std::filesystem::path path_;
  OpenedFile file_;
  std::size_t size_ = 0;
};

/// A file that is written anew. Errors name what PendingOutput makes of it.
class OutputFile {
 public:
  /// Throws OutputError.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends the pieces, one after the other. Throws OutputError.
  void write(std::initializer_list<std::string_view> pieces);
  /// Writes to the place `offset`. Throws OutputError.
  void write_at(std::size_t offset, std::string_view content) const;
  /// Throws OutputError for what the disk refuses only now.
  void close();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace mimetra
