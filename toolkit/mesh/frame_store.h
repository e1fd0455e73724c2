#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Temporary bytes in a file without a name, which disappears however the process ends.
class ScratchFile {
 public:
  /// Creates the file in std::filesystem::temp_directory_path(). Throws OutputError on failure.
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes bytes from `offset` on. Several threads may call it. Throws OutputError, for example if
  /// the disk is full.
  void write(std::size_t offset, std::span<const std::byte> bytes);
  /// Reads bytes from `offset` on. Several threads may call it. Throws IoError.
  /// \pre the bytes were written
  void read(std::size_t offset, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

/// Temporary poses: in memory up to a limit, otherwise in a ScratchFile.
class FrameStore : public FrameSource, public FrameSink {
 public:
  /// Default limit of the poses in memory, in bytes.
  static constexpr std::size_t kMemoryBytes = std::size_t{16} << 20;

  /// Throws OutputError if a ScratchFile is needed and cannot be created.
  explicit FrameStore(SequenceHeader header, std::size_t memory_bytes = kMemoryBytes);

  /// Throws std::out_of_range for missing frames, and OutputError.
  void write(int first, const Frames& poses) override;
  /// Returns no files, because the poses are temporary.
  std::vector<std::filesystem::path> commit() override { return {}; }

  std::shared_ptr<const Frames> in_memory() const override { return memory_; }
  bool is_quick() const override { return true; }
  bool reads_vertices() const override { return true; }

 private:
  /// \pre the frames were written
  void read_frames(int first, FramesView poses) const override;
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override;

  std::shared_ptr<Frames> memory_;
  std::optional<ScratchFile> file_;
};

/// The source itself if it is quick to read; otherwise its frames, read once into a FrameStore.
/// Throws whatever reading throws, OutputError, and Cancelled.
std::shared_ptr<const FrameSource> stored(std::shared_ptr<const FrameSource> source,
                                          const Context& context = {});

}  // namespace mimetra
