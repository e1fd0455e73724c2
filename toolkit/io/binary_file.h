#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>

/// Files as the operating system has them: open for reading and writing, in parts and from several
/// threads where wanted, and the temporary names of outputs.
namespace mimetra {

/// A regular file, or a pipe of the process such as bash's `<(command)`, open for reading. Nothing
/// else is waited for: what a person names by mistake, or a list names, may never end.
class OpenedFile {
 public:
  /// Throws IoError for what is not there or cannot be read, for folders, devices and sockets, for
  /// named pipes, and for pointers of Git LFS.
  explicit OpenedFile(const std::filesystem::path& path);
  ~OpenedFile();
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  int descriptor() const { return descriptor_; }
  bool is_pipe() const { return is_pipe_; }
  /// All that there is, from here on. Throws IoError; of a pipe also where more than 1 GB comes;
  /// Cancelled where a signal comes while nothing else does.
  std::string rest() const;

 private:
  /// Puts the next bytes to `to`; 0 at the end.
  std::size_t next(char* to, std::size_t most) const;

  std::string path_;
  int descriptor_;
  bool is_pipe_ = false;
};

/// Throws as OpenedFile, and for pipes: before a library opens a file by its name.
void require_regular_file(const std::filesystem::path& path);

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

enum class OutputKind { file, folder };

/// Makes an empty file or folder beside `target`, under a hidden name that was free: nothing that
/// an earlier run or anybody else has put there is used or followed. Where it cannot be made,
/// `error` says why.
std::filesystem::path make_temporary_beside(const std::filesystem::path& target, OutputKind kind,
                                            std::error_code& error);

/// What `path` is called once it is committed: without such names, which nobody asked for. Messages
/// use this name.
std::filesystem::path committed_name(const std::filesystem::path& path);

}  // namespace mimetra
