#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

/// Files of which parts are read and written, from several threads where wanted. Internal to the
/// readers and writers of large files.
namespace mimetra {

/// Why the last call to the operating system failed.
std::string last_reason();

/// An ordinary file that is open for reading.
class InputFile {
 public:
  /// True for a file whose size is that of its content: no pipe, and nothing that seems empty.
  static bool has_size(const std::filesystem::path& path);

  /// Throws IoError.
  explicit InputFile(std::filesystem::path path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::size_t size() const { return size_; }
  /// Copies `bytes` bytes from `offset` on. Throws IoError, also where the file ends before.
  void read(std::size_t offset, char* to, std::size_t bytes) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
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
