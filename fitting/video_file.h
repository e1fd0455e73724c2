#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/image.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Those of videos that can be read, in lower case.
std::vector<std::string> video_extensions();

/// True for NAME.mp4 and the like in any case.
bool is_video(const std::filesystem::path& path);

/// The frames of a video, decoded when they are needed: turned as the file says, with square
/// pixels. Going back starts from the beginning.
class VideoFile final : public ImageSequence {
 public:
  /// Decodes all frames once, to know their times. Throws IoError for what is no video, where not
  /// even its first frame can be decoded, and where FFmpeg's libraries are missing;
  /// Cancelled.
  explicit VideoFile(std::filesystem::path path, const Context& context = {});
  ~VideoFile() override;

  /// Those before the first one that is damaged.
  int frames() const override;
  /// Seconds (F): the time stamps of the frames, which rise.
  const Eigen::VectorXd& times() const;
  /// Why there are no frames after the last one, where the video is damaged or breaks off. Nothing
  /// where it is whole.
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

/// Adds .mp4, .mov and .mkv of pictures.
void add_video_format(OperationTable& table);

/// What is to be said where pictures are written to `target` without the sound of `video`; nothing
/// where it is kept, there is none, or `target` is no video. Throws IoError.
std::string lost_sound(const std::filesystem::path& target, const std::filesystem::path& video);

}  // namespace mimetra
