#pragma once

#include <filesystem>
#include <string>

/// What stands under the name of an input. Internal to the readers.
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

}  // namespace mimetra
