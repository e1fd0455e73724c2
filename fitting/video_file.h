#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/image.h"
#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Extensions of readable videos, in lower case.
std::vector<std::string> video_extensions();

/// True for NAME.mp4 and the like in any case.
bool is_video(const std::filesystem::path& path);

/// Frames of a video, decoded on demand, upright and with square pixels. Going back restarts it.
class VideoFile final : public ImageSequence {
 public:
  /// Decodes all frames once to learn their times. Throws IoError if the file is not a video, its
  /// first frame cannot be decoded, or FFmpeg's libraries are missing. Throws Cancelled.
  explicit VideoFile(std::filesystem::path path, const Context& context = {});
  ~VideoFile() override;

  /// Number of frames before the first damaged one.
  int frames() const override;
  /// Time stamps of the frames in seconds (F), ascending.
  const Eigen::VectorXd& times() const;
  /// Reason why the video ends early if it is damaged or breaks off; otherwise empty.
  const std::string& damage() const;

  Image image(int frame) const override;
  std::string name(int frame) const override;
  bool is_recording() const override { return true; }
  std::filesystem::path sound() const override;
  void check() const override {}

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Adds .mp4, .mov and .mkv as formats of pictures.
void add_video_format(OperationTable& table);

/// Warning that pictures written to `target` lose the sound of `video`. Empty if the sound is kept,
/// `video` has none, or `target` is not a video. Throws IoError.
std::string lost_sound(const std::filesystem::path& target, const std::filesystem::path& video);

}  // namespace mimetra
