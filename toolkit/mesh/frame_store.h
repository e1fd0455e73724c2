#pragma once

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/scratch_file.h"

namespace mimetra {

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
