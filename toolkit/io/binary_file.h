#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>

/// Files of the operating system, read and written in parts and by several threads, and the
/// temporary names of outputs.
namespace mimetra {

/// A regular file, or a pipe of the process such as bash's `<(command)`, open for reading. Other
/// kinds of files are refused, because reading them could wait forever.
class OpenedFile {
 public:
  /// Throws IoError if the file is missing, cannot be read, or is a folder, a device, a socket, a
  /// named pipe or a pointer of Git LFS.
  explicit OpenedFile(const std::filesystem::path& path);
  ~OpenedFile();
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  int descriptor() const { return descriptor_; }
  bool is_pipe() const { return is_pipe_; }
  /// Returns all bytes from the current position on. Throws IoError, also if a pipe delivers more
  /// than 1 GB. Throws Cancelled if a signal arrives while it waits for data.
  std::string rest() const;

 private:
  /// Reads up to `most` bytes to `to`. Returns their number, 0 at the end.
  std::size_t next(char* to, std::size_t most) const;

  std::string path_;
  int descriptor_;
  bool is_pipe_ = false;
};

/// Throws IoError as OpenedFile does, and also for pipes. Call it before a library opens the file
/// by its name.
void require_regular_file(const std::filesystem::path& path);

/// Bytes that several threads may read in parts.
class InputBytes {
 public:
  InputBytes() = default;
  virtual ~InputBytes() = default;
  InputBytes(const InputBytes&) = delete;
  InputBytes& operator=(const InputBytes&) = delete;

  virtual std::size_t size() const = 0;
  /// Copies `bytes` bytes from `offset` on. Throws IoError, also if the bytes end too early.
  virtual void read(std::size_t offset, char* to, std::size_t bytes) const = 0;
};

/// An ordinary file that is open for reading.
class InputFile : public InputBytes {
 public:
  /// True for a regular file that is not empty. Pipes have no size, and some system files report 0
  /// although they have content.
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

/// A new file, or a file whose content is replaced. Errors show the name that PendingOutput will
/// give to it.
class OutputFile {
 public:
  /// Throws OutputError.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends the pieces, one after the other. Throws OutputError.
  void write(std::initializer_list<std::string_view> pieces);
  /// Throws OutputError.
  void write_at(std::size_t offset, std::string_view content) const;
  /// Throws OutputError, because some disks report a failed write only now.
  void close();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  int descriptor_;
};

enum class OutputKind { file, folder };

/// Creates an empty file or folder beside `target`, under a hidden, unused name. Existing files,
/// folders and links are neither used nor followed. If it fails, returns an empty path and sets
/// `error`.
std::filesystem::path make_temporary_beside(const std::filesystem::path& target, OutputKind kind,
                                            std::error_code& error);

/// Name of `path` after it is committed: temporary names are replaced by their targets.
std::filesystem::path committed_name(const std::filesystem::path& path);

}  // namespace mimetra
