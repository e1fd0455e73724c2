#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "toolkit/mesh/frame_source.h"

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

/// Poses that are kept while they are needed: in memory as long as they are few, otherwise in a
/// ScratchFile.
class FrameStore : public FrameSource, public FrameSink {
 public:
  /// Most bytes of poses in memory.
  static constexpr std::size_t kMemoryBytes = std::size_t{16} << 20;

  /// Throws OutputError where there can be no ScratchFile.
  explicit FrameStore(SequenceHeader header, std::size_t memory_bytes = kMemoryBytes);

  /// Throws std::out_of_range for frames that are not there, OutputError.
  void write(int first, const Frames& poses) override;
  /// There is no file to return.
  std::vector<std::filesystem::path> commit() override { return {}; }

  std::shared_ptr<const Frames> in_memory() const override { return memory_; }
  bool is_quick() const override { return true; }
  bool reads_vertices() const override { return true; }

 private:
  /// \pre they were written
  void read_frames(int first, FramesView poses) const override;
  void read_some_vertices(int first, VertexIndex vertex, FramesView poses) const override;

  std::shared_ptr<Frames> memory_;
  std::optional<ScratchFile> file_;
};

/// The source itself where it is quick to read; otherwise its frames, read once, in a FrameStore.
/// Throws what reading throws, OutputError, Cancelled.
std::shared_ptr<const FrameSource> stored(std::shared_ptr<const FrameSource> source,
                                          const Context& context = {});

}  // namespace mimetra
