#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace mimetra {

/// Bytes that are kept while they are needed, in a file that has no name, so that nothing is left
/// of it however the process ends.
class ScratchFile {
 public:
  /// It lies in std::filesystem::temp_directory_path(). Throws OutputError where it cannot.
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// From `offset` on, from several threads. Throws OutputError, as where the disk is full.
  void write(std::size_t offset, std::span<const std::byte> bytes);
  /// \pre they were written. From several threads. Throws IoError.
  void read(std::size_t offset, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

}  // namespace mimetra
